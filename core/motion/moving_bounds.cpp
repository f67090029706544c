#include "motion/moving_bounds.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/decompose.h"

namespace dg {
namespace {

using Corners = std::array<Vec3d, 8>;
using Segment = Motion::Segment;
using Track = Motion::Track;

/// Relative cost of a tree that is interpolated in time (measured).
constexpr double kMovingCost = 1.25;
/// Number of turns in the interval above which a single box of the swept disc is as good.
constexpr double kMostTurns = 4;
/// Halving the steps must reduce the boxes' area by this fraction.
constexpr double kWorthwhile = 0.05;

Corners corners_of(const Box& b) {
    Corners c;
    for (int i = 0; i < 8; ++i)
        c[i] = {i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z};
    return c;
}

Box join(const Box& a, const Box& b) {
    Box c;
    for (int k = 0; k < 3; ++k) {
        c.min[k] = std::min(a.min[k], b.min[k]);
        c.max[k] = std::max(a.max[k], b.max[k]);
    }
    return c;
}

Vec3d across(Vec3d v, Vec3d axis) { return v - axis * dot(v, axis); }
Vec3d row(const Affine3d& m, int k) { return {m.x[k], m.y[k], m.z[k]}; }

/// Moving body: the hull, or its sweep over all angles of a spin.
struct Body {
    const Hull& hull;
    const Spin* sweep = nullptr;
    Corners corners;  // of a bounding box

    Body(const Hull& hull, const Spin* sweep) : hull(hull), sweep(sweep) {
        Box box;
        for (int k = 0; k < 3; ++k) {
            Vec3d d;
            d[k] = 1;
            box.max[k] = reach(d);
            box.min[k] = -reach(-d);
        }
        corners = corners_of(box);
    }

    double reach(Vec3d d) const {
        if (!sweep) return hull.reach(d);
        // All rotated copies of d are in the convex hull of kTurns directions with a slightly
        // longer component across the axis.
        constexpr int kTurns = 32;
        const double longer = 1 / std::cos(kPiD / kTurns);
        const Vec3d a = sweep->axis, along = a * dot(d, a), u = across(d, a) * longer, v = cross(a, u);
        double most = -std::numeric_limits<double>::infinity();
        for (int i = 0; i < kTurns; ++i) {
            const double angle = 2 * kPiD * i / kTurns;
            const Vec3d turned = along + u * std::cos(angle) + v * std::sin(angle);
            most = std::max(most, hull.reach(turned) - dot(turned, sweep->center));
        }
        return most + dot(d, sweep->center);
    }

    /// Maximum of |f(p)| over the body for linear f: a convex function is largest at a corner.
    template <typename F>
    double most(const F& f) const {
        double r = 0;
        for (const Vec3d p : corners) r = std::max(r, length(f(p)));
        return r;
    }
};

/// Part of a segment: fractions s0 .. s1 of it, at times t0 .. t1.
struct Piece {
    const Segment& segment;
    double t0, t1, s0, s1;
    double rate;  // ds / dt
};

/// Calls visit(piece) for the pieces from `begin` to `end`, in order.
template <typename Visit>
void for_pieces(const Track& track, double begin, double end, const Visit& visit) {
    const auto& times = track.times;
    if (begin < times[0]) visit(Piece{track.segments[0], begin, std::min(end, times[0]), 0, 0, 0});
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool held = i + 1 == times.size();
        const double t0 = std::max(begin, times[i]), t1 = held ? end : std::min(end, times[i + 1]);
        if (t0 > t1) continue;
        const double rate = held || !(times[i + 1] > times[i]) ? 0 : 1 / (times[i + 1] - times[i]);
        const auto share = [&](double t) { return std::clamp((t - times[i]) * rate, 0.0, 1.0); };
        visit(Piece{track.segments[i], t0, t1, share(t0), share(t1), rate});
    }
}

/// Bounds of the rates of change of a segment's transform over the piece.
struct Rates {
    double turn = 0;     // rad per time, about `axis` in the world
    Vec3d axis{};
    double size = 0;     // norm of the linear part
    double growth = 0;   // rate of change apart from the rotation, per time
    bool constant() const { return turn == 0 && growth == 0; }
};

Rates rates_of(const Piece& p) {
    const Segment& g = p.segment;
    if (p.rate == 0) return {0, {}, spectral_norm(g.first), 0};
    if (!g.turns) {
        const double size = std::max(spectral_norm(g.at(p.s0, {})), spectral_norm(g.at(p.s1, {})));
        return {0, {}, size, spectral_norm(g.change) * p.rate};
    }
    const double size =
        std::max(spectral_norm(g.stretch_at(p.s0)), spectral_norm(g.stretch_at(p.s1)));
    return {g.angle * p.rate, g.rotation.rotate(g.axis), size,
            spectral_norm(g.change) * p.rate};
}

/// Length of each world axis's component perpendicular to `axis`.
Vec3d across_shares(Vec3d axis) {
    const auto share = [](double c) { return std::sqrt(std::max(0.0, 1 - c * c)); };
    return {share(axis.x), share(axis.y), share(axis.z)};
}

/// Bound of |x''| along each world axis, without a spin.
Vec3d bend_turning(const Body& body, const Track& track, const Piece& p, const Rates& r) {
    if (r.turn == 0) return {};
    const Segment& g = p.segment;
    const auto aside = [&](const Affine3d& stretch) {
        return body.most([&](Vec3d q) { return across(stretch.vector(q - track.pivot), g.axis); });
    };
    const double arm = std::max(aside(g.stretch_at(p.s0)), aside(g.stretch_at(p.s1)));
    const double growth = aside(g.change) * p.rate;
    return across_shares(r.axis) * (r.turn * r.turn * arm + 2 * r.turn * growth);
}

/// Bound of |x''| with a spin inside: x = A(y), y = B p, so x'' = A'' y + 2 A' y' + A y''.
Vec3d bend_spinning(const Body& body, const Track& track, const Piece& p, const Rates& r) {
    const Spin& spin = track.spin;
    const double w = 2 * kPiD * std::abs(spin.revolutions_per_second);
    const double arm = body.most([&](Vec3d q) { return across(q - spin.center, spin.axis); });
    const double far = length(spin.center - track.pivot) +
                       body.most([&](Vec3d q) { return q - spin.center; });
    const double outer = r.turn * r.turn * r.size * far + 2 * r.turn * r.growth * far;
    const double mixed = 2 * (r.turn * r.size + r.growth) * w * arm;
    Vec3d bend = across_shares(r.axis) * outer + Vec3d{mixed, mixed, mixed};
    const Affine3d m = p.segment.at(p.s0, track.pivot);
    for (int k = 0; k < 3; ++k) {
        const double inner = r.constant() ? length(across(row(m, k), spin.axis)) : r.size;
        bend[k] += inner * w * w * arm;
    }
    return bend;
}

Box box_at(const Body& body, const Affine3d& m) {
    Box b;
    for (int k = 0; k < 3; ++k) {
        const Vec3d d = row(m, k);
        b.max[k] = body.reach(d) + m.origin[k];
        b.min[k] = -body.reach(-d) + m.origin[k];
    }
    return b;
}

/// Box that the bounds must contain at a time.
struct Demand {
    double time;
    Box box;
};

/// Required boxes of a step: the boxes at both ends of each piece, enlarged by the bound on
/// curvature.
std::vector<Demand> demands(const Body& body, const Track& track, double begin, double end) {
    std::vector<Demand> all;
    const bool spins = track.spins() && !body.sweep;
    for_pieces(track, begin, end, [&](const Piece& p) {
        const Rates rates = rates_of(p);
        const Vec3d bend = spins ? bend_spinning(body, track, p, rates)
                                 : bend_turning(body, track, p, rates);
        const Vec3d grow = bend * ((p.t1 - p.t0) * (p.t1 - p.t0) / 8);
        for (const auto& [time, share] : {std::pair{p.t0, p.s0}, {p.t1, p.s1}}) {
            Affine3d m = p.segment.at(share, track.pivot);
            if (spins) m = m * track.spun(time);
            Box box = box_at(body, m);
            all.push_back({time, {box.min - grow, box.max + grow}});
        }
    });
    return all;
}

/// Boxes at n + 1 steps such that linear interpolation of neighbours contains the body at every
/// time.
std::vector<Box> boxes_at_steps(const Body& body, const Track& track, int n) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Vec3d far{kInfinity, kInfinity, kInfinity};
    std::vector<Box> boxes(n + 1, Box{far, -far});
    std::vector<std::vector<Demand>> between(n);
    for (int i = 0; i < n; ++i) {
        const double begin = double(i) / n, end = double(i + 1) / n;
        between[i] = demands(body, track, begin, end);
        for (const Demand& d : between[i]) {
            if (d.time <= begin) boxes[i] = join(boxes[i], d.box);
            if (d.time >= end) boxes[i + 1] = join(boxes[i + 1], d.box);
        }
    }
    // Keys inside a step: move both of its boxes outward until their interpolation contains them.
    for (int i = 0; i < n; ++i) {
        Box &a = boxes[i], &b = boxes[i + 1];
        for (const Demand& d : between[i]) {
            const double s = d.time * n - i;
            for (int k = 0; k < 3; ++k) {
                const double low = std::min(0.0, d.box.min[k] - (a.min[k] * (1 - s) + b.min[k] * s));
                const double high = std::max(0.0, d.box.max[k] - (a.max[k] * (1 - s) + b.max[k] * s));
                a.min[k] += low, b.min[k] += low;
                a.max[k] += high, b.max[k] += high;
            }
        }
    }
    return boxes;
}

double mean_area(const std::vector<Box>& boxes) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < boxes.size(); ++i)
        sum += (boxes[i].half_area() + boxes[i + 1].half_area()) / 2;
    return sum / double(boxes.size() - 1);
}

Box union_of(const std::vector<Box>& boxes) {
    Box all = boxes[0];
    for (const Box& b : boxes) all = join(all, b);
    return all;
}

/// Doubles the number of steps while the boxes shrink noticeably; a single box if they hardly
/// change.
std::vector<Box> best_boxes(const Body& body, const Track& track) {
    // Start near the keys' spacing; coarser steps are not worth trying.
    const int keys = int(std::min<std::size_t>(track.segments.size(), 2 * kMostMotionSteps));
    int n = std::max(1, int(std::bit_ceil(unsigned(keys))) / 2);
    std::vector<Box> best = boxes_at_steps(body, track, n);
    for (n *= 2; n <= kMostMotionSteps; n *= 2) {
        std::vector<Box> finer = boxes_at_steps(body, track, n);
        const bool worth = mean_area(finer) < (1 - kWorthwhile) * mean_area(best);
        if (worth) best = std::move(finer);
        if (!worth && n >= int(track.segments.size())) break;
    }
    return best;
}

/// Balls about the centre of the body along its path, enlarged by the size of the centre's box per
/// step.
std::vector<Ball> balls_along(const Hull& hull, const Body& body, const Track& track, int n) {
    const Vec3f middle = to_float(hull.center());
    const double radius = hull.radius() + length(to_double(middle) - hull.center());
    const Hull point(std::span(&middle, 1));
    const std::vector<Box> way = boxes_at_steps(Body(point, body.sweep), track, n);
    std::vector<Ball> balls;
    for (const Box& b : way) balls.push_back({(b.min + b.max) * 0.5, length(b.max - b.min) / 2});
    for (int i = 0; i < n; ++i) {
        double size = 0;
        for_pieces(track, double(i) / n, double(i + 1) / n,
                   [&](const Piece& p) { size = std::max(size, rates_of(p).size); });
        balls[i].radius = std::max(balls[i].radius, balls[i + 1].radius) + size * radius;
    }
    return balls;
}

}  // namespace

Ball MovingBounds::ball_at(double time) const {
    const std::size_t n = balls.size() - 1;
    if (n == 0) return balls[0];
    const double x = std::clamp(time, 0.0, 1.0) * double(n);
    const std::size_t i = std::min(std::size_t(x), n - 1);
    const double s = x - double(i);
    return {balls[i].center * (1 - s) + balls[i + 1].center * s, balls[i].radius};
}

MovingBounds moving_bounds(const Hull& hull, const Motion& motion) {
    const Track* track = motion.track();
    if (!track) {
        const Affine3d m = motion.at(0);
        return {{box_at(Body(hull, nullptr), m)},
                {{m.point(hull.center()), spectral_norm(m) * hull.radius()}}};
    }
    const bool fast = std::abs(track->spin.revolutions_per_second) > kMostTurns;
    const Body body(hull, fast ? &track->spin : nullptr);
    MovingBounds bounds{best_boxes(body, *track), {}};
    bounds.balls = balls_along(hull, body, *track, int(bounds.boxes.size()) - 1);
    const Box all = union_of(bounds.boxes);
    if (all.half_area() < kMovingCost * mean_area(bounds.boxes)) bounds.boxes = {all};
    return bounds;
}

}  // namespace dg
