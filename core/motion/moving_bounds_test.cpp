// moving_bounds_test.cpp -- points of moving meshes are always inside their boxes and balls.
#include "motion/moving_bounds.h"

#include <doctest/doctest.h>

#include <random>

using namespace dg;

namespace {

struct Random {
    std::mt19937 generator{11};
    double operator()(double low = -1, double high = 1) {
        return std::uniform_real_distribution<double>(low, high)(generator);
    }
    Vec3d vector(double size = 1) { return Vec3d{(*this)(), (*this)(), (*this)()} * size; }
    Vec3d direction() {
        const Vec3d v = vector();
        return length(v) > 0.1 ? normalize(v) : direction();
    }
    Affine3d rigid(double reach) {
        Affine3d m = to_matrix(Quaterniond::from_axis_angle(direction(), (*this)() * kPiD));
        m.origin = vector(reach);
        return m;
    }
    Affine3d any(double reach) {
        Affine3d m = rigid(reach);
        m.x = m.x * (*this)(0.2, 2) + vector(0.2);
        m.y = m.y * (*this)(0.2, 2);
        m.z = m.z * (*this)(-2, 2);
        return m;
    }
};

std::vector<Vec3f> cloud(Random& random, Vec3d middle, Vec3d size) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 40; ++i) points.push_back(to_float(middle + random.vector() * size));
    return points;
}

/// Box at a time, interpolated like the ray tracer does.
Box box_at(const MovingBounds& bounds, double t) {
    const std::size_t n = bounds.boxes.size() - 1;
    if (n == 0) return bounds.boxes[0];
    const std::size_t i = std::min(std::size_t(t * double(n)), n - 1);
    const double s = t * double(n) - double(i);
    const Box &a = bounds.boxes[i], &b = bounds.boxes[i + 1];
    return {a.min * (1 - s) + b.min * s, a.max * (1 - s) + b.max * s};
}

struct Check {
    int outside = 0;
    double furthest = 0;  // distance outside, relative to the size of the mesh
    double area = 0;      // mean area of the boxes relative to the points' box
};

Check check(const std::vector<Vec3f>& points, const Motion& motion, Random& random, int times) {
    const Hull hull(points);
    const MovingBounds bounds = moving_bounds(hull, motion);
    Check result;
    for (int i = 0; i < times; ++i) {
        const double t = i < 3 ? i / 2.0 : random(0, 1);
        const Affine3d m = motion.at(t);
        const Box box = box_at(bounds, t);
        const Ball ball = bounds.ball_at(t);
        double reach = 0;
        Box tight{m.point(to_double(points[0])), m.point(to_double(points[0]))};
        for (const Vec3f& p : points) {
            const Vec3d q = m.point(to_double(p));
            double out = length(q - ball.center) - ball.radius;
            for (int k = 0; k < 3; ++k) {
                out = std::max({out, box.min[k] - q[k], q[k] - box.max[k]});
                tight.min[k] = std::min(tight.min[k], q[k]);
                tight.max[k] = std::max(tight.max[k], q[k]);
            }
            reach = std::max(reach, out);
        }
        const double rounding = 1e-9 * (1 + length(m.origin)) + 1e-6 * hull.radius();
        if (reach > rounding) ++result.outside;
        result.furthest = std::max(result.furthest, reach / hull.radius());
        result.area += box.half_area() / tight.half_area() / times;
    }
    return result;
}

}  // namespace

TEST_CASE("a hull reaches as far as its points, and hardly further") {
    Random random;
    std::vector<Vec3f> ball;
    for (int i = 0; i < 3000; ++i) ball.push_back(to_float(random.direction() + Vec3d{3, 2, 1}));
    const Hull hull(ball);
    CHECK(hull.radius() < 1.05);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d d = random.direction() * random(0.1, 10);
        double most = -1e30;
        for (const Vec3f& p : ball) most = std::max(most, dot(d, to_double(p)));
        CHECK(hull.reach(d) >= most);
        CHECK(hull.reach(d) < most + 0.02 * length(d));
    }
    CHECK(hull.reach({0, 0, 0}) == 0);
}

TEST_CASE("no point leaves the bounds: every interpolation, keys, pivots, spins, jumps") {
    Random random;
    for (int round = 0; round < 400; ++round) {
        const auto how = Interpolation(round % 4);
        const double reach = round % 3 == 0 ? 100 : 1;
        std::vector<double> times;
        std::vector<Affine3d> keys;
        const int count = 1 + round % 5;
        double t = random(-1, 0.5);
        for (int i = 0; i < count; ++i) {
            times.push_back(t);
            keys.push_back(how == Interpolation::linear || how == Interpolation::decomposed
                               ? random.any(reach) : random.rigid(reach));
            if (random() > -0.6) t += random(0.01, 0.8);   // else a jump
        }
        Motion motion = Motion::keys(times, keys, how, random.vector(round % 2 ? 5 : 0));
        if (round % 7 == 0)
            motion = motion.spinning({random.direction(), random() * std::pow(10, random(-1, 2)),
                                      random.vector(round % 3), random()});
        const auto points = cloud(random, random.vector(round % 2 ? 20 : 0), {1, random(0.01, 1), 0.3});
        const Check c = check(points, motion, random, 300);
        CAPTURE(round);
        CAPTURE(c.furthest);
        CHECK(c.outside == 0);
    }
}

TEST_CASE("a small quad far from its pivot stays inside boxes of its own size") {
    Random random;
    const std::vector<Vec3f> quad{{100, -0.02f, 0}, {100, 0.02f, 0}, {100, 0, 0.04f}, {100, 0, 0}};
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle({0, 0, 1}, 3.5 * kPiD / 180));
    const std::array times{0.0, 1.0};
    const std::array keys{Affine3d{}, turn};
    const Motion motion = Motion::keys(times, keys, Interpolation::decomposed);
    const Check c = check(quad, motion, random, 5000);
    CHECK(c.outside == 0);
    CHECK(c.area < 2);
}

TEST_CASE("boxes are small: turns in place, straight flights, propellers") {
    Random random;
    std::vector<Vec3f> ball, bar;
    for (int i = 0; i < 500; ++i) ball.push_back(to_float(random.direction()));
    for (int i = 0; i < 500; ++i) bar.push_back(to_float(random.vector() * Vec3d{1, 0.05, 0.02}));
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle({0, 1, 0}, kPiD / 4));
    turn.origin = {6, 0, 0};
    const std::array times{0.0, 1.0};
    const std::array keys{Affine3d{}, turn};
    const Motion flies = Motion::keys(times, keys, Interpolation::decomposed);
    CHECK(check(ball, flies, random, 300).area < 1.1);
    const Motion spins = Motion().spinning({{0, 0, 1}, 50, {0, 0, 0}, 0});
    CHECK(moving_bounds(Hull(ball), spins).boxes.size() == 1);
    const MovingBounds disc = moving_bounds(Hull(bar), spins);
    CHECK(disc.boxes.size() == 1);
    CHECK(disc.boxes[0].max.z < 0.03);
    CHECK(disc.boxes[0].max.x < 1.1);
    const Motion turns = Motion().spinning({{0, 0, 1}, 3, {0, 0, 0}, 0});
    CHECK(check(bar, turns, random, 3000).area < 2.2);
}
