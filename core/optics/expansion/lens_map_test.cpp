// Taylor expansion of a lens against the exact trace, first-order optics, Seidel sums and
// symplecticity.
#include "optics/expansion/lens_map.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

#include "math/linear_solve.h"
#include "optics/expansion/elements.h"
#include "optics/first_order/seidel.h"
#include "optics/lens/lens_error.h"
#include "optics/lens/test_lenses.h"
#include "optics/stray/ghost.h"

using namespace dg;

namespace {

LensWay to_film(const Tracer& tracer, double start_z, double end_z) {
    const int count = int(tracer.prescription().surfaces.size());
    return {straight_path(count, true), start_z, end_z, false, {}};
}

RayMap expansion(const Tracer& tracer, const LensWay& way, int degree) {
    return lens_map(tracer, tracer.at(kDesignWavelength), way, degree);
}

/// Exact ray on the same planes, without clipping.
RayNumbers exact(const Tracer& tracer, const LensWay& way, const RayNumbers& r) {
    const double dz = std::sqrt(1 - r[2] * r[2] - r[3] * r[3]);
    TracedRay traced{{{r[0], r[1], way.start_z}, {r[2], r[3], way.path[0].sign * dz}}};
    const LensIndices n = tracer.at(kDesignWavelength);
    REQUIRE(tracer.follow(traced, way.path, n, {false, nullptr, 0}) < 0);
    const Vec3d p = at_plane(traced.ray, way.end_z), d = traced.ray.direction;
    return {p.x, p.y, d.x, d.y};
}

/// Coefficients of t^0 .. t^7 of f on [-1, 1], from Chebyshev polynomials up to degree 17 on 40
/// nodes. Higher degrees contain only rounding errors.
std::vector<RayNumbers> along_line(const std::function<RayNumbers(double)>& f) {
    constexpr int kNodes = 40, kTerms = 18, kWanted = 8;
    std::vector<RayNumbers> chebyshev(kTerms), power(kWanted);
    for (int k = 0; k < kNodes; ++k) {
        const double angle = kPiD * (k + 0.5) / kNodes;
        const RayNumbers value = f(std::cos(angle));
        for (int j = 0; j < kTerms; ++j)
            for (int o = 0; o < 4; ++o)
                chebyshev[j][o] +=
                    (j ? 2.0 : 1.0) / kNodes * value[o] * std::cos(j * angle);
    }
    std::vector<double> t(kTerms), next(kTerms);  // T_j and T_{j+1} as power series
    t[0] = next[1] = 1;
    for (int j = 0; j < kTerms; ++j) {
        for (int g = 0; g < kWanted; ++g)
            for (int o = 0; o < 4; ++o) power[g][o] += chebyshev[j][o] * t[g];
        for (int g = kTerms - 1; g >= 0; --g)  // T_{j+2} = 2 x T_{j+1} - T_j
            t[g] = (g ? 2 * next[g - 1] : 0) - t[g];
        std::swap(t, next);
    }
    return power;
}

double power_product(const RayNumbers& v, const std::array<int, 4>& e) {
    return std::pow(v[0], e[0]) * std::pow(v[1], e[1]) * std::pow(v[2], e[2]) *
           std::pow(v[3], e[3]);
}

/// Largest difference between the map's coefficients of degree g and derivatives of the exact
/// trace, relative to the largest coefficient of the output. `unit`: step per coordinate.
double derivative_error(const Tracer& tracer, const LensWay& way, const RayMap& map,
                        int g, const RayNumbers& unit) {
    const Monomials& m = *map.out[0].monomials();
    const int first = m.count_to(g - 1), count = m.count_to(g) - first, rows = 3 * count;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> matrix, rhs;
    for (int row = 0; row < rows; ++row) {
        RayNumbers v;
        double length = 0;
        for (double& x : v) x = normal(random), length += x * x;
        for (double& x : v) x /= std::sqrt(length);
        for (int i = 0; i < count; ++i)
            matrix.push_back(power_product(v, m.exponents(first + i)));
        const auto line = along_line([&](double t) {
            RayNumbers r = way.about;
            for (int k = 0; k < 4; ++k) r[k] += t * v[k] * unit[k];
            return exact(tracer, way, r);
        });
        rhs.insert(rhs.end(), line[g].begin(), line[g].end());
    }
    const std::vector<double> c = least_squares(matrix, rows, count, rhs, 4);
    double worst = 0;
    for (int o = 0; o < 4; ++o) {
        double largest = 0, error = 0;
        for (int i = 0; i < count; ++i) {
            const double mine =
                map.out[o][first + i] * power_product(unit, m.exponents(first + i));
            largest = std::max(largest, std::abs(c[4 * i + o]));
            error = std::max(error, std::abs(mine - c[4 * i + o]));
        }
        if (largest > 0) worst = std::max(worst, error / largest);
    }
    return worst;
}

/// Largest difference of two maps up to a degree, with coefficients scaled by the steps.
double difference(const RayMap& a, const RayMap& b, int degree, const RayNumbers& unit) {
    const Monomials& m = Monomials::of(degree);
    double worst = 0;
    for (int o = 0; o < 4; ++o)
        for (int i = 0; i < m.count(); ++i)
            worst = std::max(worst, std::abs(a.out[o][i] - b.out[o][i]) *
                                        power_product(unit, m.exponents(i)));
    return worst;
}

/// The lens composed of elements, each expanded about the base ray at its place.
RayMap assembled(const Tracer& tracer, const LensWay& way, int degree) {
    const LensIndices n = tracer.at(kDesignWavelength);
    RayMap all = propagation(0, degree, way.about);
    const auto then = [&](const RayMap& next) { all = compose(next, all); };
    double z = way.start_z;
    int sign = way.path.front().sign;
    for (const PathStep& step : way.path) {
        Surface s = tracer.prescription().surfaces[step.surface];
        const double vertex = tracer.vertices()[step.surface];
        if (sign < 0) {  // seen from behind
            s.curvature = -s.curvature, s.curvature_x = -s.curvature_x;
            for (AsphereTerm& a : s.asphere) a.coefficient = -a.coefficient;
        }
        then(propagation(sign * (vertex - z), degree, all.image()));
        then(step.reflects ? reflection(SurfaceForm(s, 0), degree, all.image())
                           : refraction(SurfaceForm(s, 0), n.index[step.before()],
                                        n.index[step.behind()], degree, all.image()));
        if (step.reflects) sign = -sign;
        z = vertex;
    }
    then(propagation(sign * (way.end_z - z), degree, all.image()));
    return all;
}

/// Largest entry of J^T O J - (n / n') O, where O is the symplectic form of (x, y, dx, dy).
double symplectic_error(const RayMap& map, const RayNumbers& ray) {
    const Matrix4x4 j = map.jacobian(ray);
    double worst = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            double sum = 0;
            for (int k = 0; k < 2; ++k)
                sum += j[k][a] * j[k + 2][b] - j[k + 2][a] * j[k][b];
            const double wanted = b == a + 2 ? 1 : a == b + 2 ? -1 : 0;
            worst = std::max(worst, std::abs(sum - wanted));
        }
    return worst;
}

/// Double Gauss with a conic and an asphere, and optionally surfaces without symmetry.
Prescription general_lens(bool symmetric) {
    Prescription lens = test::check_lens(true, 0.5);
    lens.name = symmetric ? "aspheric" : "general";
    lens.surfaces[0].conic = -0.7;
    lens.surfaces[0].asphere = {{2, 1e-4}, {4, 2e-6}, {6, -3e-9}};
    if (symmetric) return lens;
    Surface &biconic = lens.surfaces[2], &toroid = lens.surfaces[4];
    biconic.shape = Shape::biconic, biconic.curvature_x = 1.1 * biconic.curvature;
    biconic.conic = 0.2, biconic.conic_x = -0.3;
    toroid.shape = Shape::toroid, toroid.curvature_x = 0.9 * toroid.curvature;
    lens.surfaces[9].shape = Shape::biconic;  // cylinder
    lens.surfaces[9].curvature_x = 0;
    lens.surfaces[6].decenter = {0.4, -0.3, 0.05};
    lens.surfaces[7].tilt = {0.7, -1.1, 3};
    return lens;
}

std::vector<Prescription> lenses() {
    std::vector<Prescription> all = test::all_lenses();
    all.push_back(general_lens(true));
    return all;
}

LensWay film_way(const Tracer& tracer) {
    const FirstOrder f = first_order(tracer.prescription());
    return to_film(tracer, f.entrance_pupil_z, f.back_focal_z);
}

/// Steps for which the Taylor series of a lens converges well.
RayNumbers units(const Tracer& tracer) {
    const FirstOrder f = first_order(tracer.prescription());
    const double r = 0.1 * f.entrance_pupil_diameter, slope = std::min(0.15, 7.5 / f.efl);
    return {r, r, slope, slope};
}

}  // namespace

TEST_CASE("degrees 1, 3 and 5 are the derivatives of the exact trace to 1e-6") {
    for (const Prescription& lens : lenses()) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const LensWay way = film_way(tracer);
        const RayMap map = expansion(tracer, way, 7);
        for (const int g : {1, 3, 5}) {
            CAPTURE(g);
            CHECK(derivative_error(tracer, way, map, g, units(tracer)) < 1e-6);
        }
    }
}

TEST_CASE("so are all degrees of a lens without symmetry, and about a ray off the axis") {
    Prescription odd = general_lens(true);
    odd.surfaces[0].asphere.push_back({3, 1e-6});
    for (const Prescription& lens : {general_lens(false), odd}) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        LensWay way = film_way(tracer);
        if (lens.name == "aspheric") way.about = {8, 5, -0.1, -0.05};
        const RayMap map = expansion(tracer, way, 5);
        const RayNumbers end = exact(tracer, way, way.about);
        for (int o = 0; o < 4; ++o) CHECK(map.out[o].value() == doctest::Approx(end[o]));
        RayNumbers unit = units(tracer);
        for (double& u : unit) u *= lens.name == "general" ? 0.5 : 1;
        for (int g = 1; g <= 5; ++g) {
            CAPTURE(g);
            CHECK(derivative_error(tracer, way, map, g, unit) < 1e-6);
        }
    }
}

TEST_CASE("degree 1 is the ABCD matrix, and odd degrees alone occur about the axis") {
    for (const Prescription& lens : lenses()) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const FirstOrder f = first_order(lens);
        // Between the focal planes: x' = f d, d' = -x / f.
        const RayMap map =
            expansion(tracer, to_film(tracer, f.front_focal_z, f.back_focal_z), 6);
        const Matrix4x4 j = map.jacobian({});
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const double wanted = b == a + 2 ? f.efl : a == b + 2 ? -1 / f.efl : 0;
                CHECK(std::abs(j[a][b] - wanted) < 1e-12 * f.efl);
            }
        const Monomials& m = Monomials::of(6);
        for (int o = 0; o < 4; ++o)
            for (int i = 0; i < m.count(); ++i)
                if (m.degree_of(i) % 2 == 0) REQUIRE(map.out[o][i] == 0);
    }
}

TEST_CASE("degree 3 is the Seidel sums of the prescription") {
    for (const Prescription& lens : lenses()) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const FirstOrder f = first_order(lens);
        const RayMap map = expansion(tracer, film_way(tracer), 3);
        const Seidel sums = seidel(lens, kDesignWavelength, {1, 1});
        const double k = 1 / sums.image_convergence;
        // x' as a function of pupil point (x, y) and slope (tx, ty); d = t - t |t|^2 / 2
        // contributes to the distortion. W as in seidel.h, transverse aberration k grad W.
        const auto at = [&](std::array<int, 4> e) {
            const Monomials& m = Monomials::of(3);
            for (int i = 0; i < m.count(); ++i)
                if (m.exponents(i) == e) return map.out[0][i];
            return 0.0;
        };
        const double spherical = at({3, 0, 0, 0}), coma = at({0, 2, 1, 0});
        const double astigmatism = at({0, 1, 1, 1}), field = at({1, 0, 0, 2});
        const double distortion = at({0, 0, 1, 2}) - f.efl / 2;
        const SeidelSums& s = sums.total;
        const auto agrees = [&](double mine, double sum) {
            CHECK(std::abs(mine - k * sum) <
                  1e-9 * std::abs(k) * (std::abs(sum) + 1e-3 * std::abs(s.s4)));
        };
        agrees(spherical, s.s1 / 2);
        agrees(coma, s.s2 / 2);
        agrees(astigmatism, s.s3);
        agrees(field, (s.s3 + s.s4) / 2);
        agrees(distortion, s.s5 / 2);
        CHECK(at({2, 0, 1, 0}) == doctest::Approx(3 * coma));
        CHECK(at({1, 0, 2, 0}) == doctest::Approx(field + astigmatism));
    }
}

TEST_CASE("a lens is the composition of its elements, cut before or after") {
    std::vector<Prescription> all = lenses();
    all.resize(4), all.push_back(general_lens(true));
    for (const Prescription& lens : all) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const int count = int(lens.surfaces.size());
        const LensWay way = film_way(tracer);
        LensWay back = way;
        back.path = straight_path(count, false), std::swap(back.start_z, back.end_z);
        LensWay ghost = way;
        ghost.path = ghost_path(tracer, 1, count - 1, true);
        LensWay about = way;
        about.about = {1, -2, 0.05, 0.1};
        for (const LensWay& w : {way, back, ghost, about}) {
            const RayMap whole = expansion(tracer, w, 7);
            CHECK(difference(whole, assembled(tracer, w, 7), 7, units(tracer)) < 1e-9);
            CHECK(difference(whole, assembled(tracer, w, 5), 5, units(tracer)) < 1e-9);
            CHECK(difference(whole, truncated(whole, 3), 3, units(tracer)) == 0);
        }
    }
}

TEST_CASE("a form that is searched has the series of the same form met in closed form") {
    Surface conic, biconic;
    conic.curvature = biconic.curvature = biconic.curvature_x = 1 / 40.0;
    conic.conic = biconic.conic = biconic.conic_x = -0.6;
    biconic.shape = Shape::biconic;
    const RayNumbers steep{8, 3, 0.6, -0.3};
    for (const int degree : {2, 5, 9}) {
        const RayMap closed = refraction(SurfaceForm(conic, 0), 1, 1.6, degree, steep);
        const RayMap searched =
            refraction(SurfaceForm(biconic, 0), 1, 1.6, degree, steep);
        CHECK(difference(closed, searched, degree, {2, 2, 0.1, 0.1}) < 1e-9);
    }
}

TEST_CASE("the inverse composes to the identity, and is the lens from behind") {
    for (const Prescription& lens : {test::tessar(), general_lens(false)}) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const LensWay way = film_way(tracer);
        const RayMap map = expansion(tracer, way, 5), undone = inverse(map);
        const RayNumbers unit = units(tracer);
        CHECK(difference(compose(undone, map), propagation(0, 5), 5, unit) < 1e-10);
        LensWay aside = way;
        aside.about = {1, -0.5, 0.02, 0.03};
        const RayMap off = expansion(tracer, aside, 5);
        CHECK(difference(compose(inverse(off), off), propagation(0, 5, aside.about), 5,
                         unit) < 1e-10);
        RayMap there = propagation(0, 5, map.image());
        CHECK(difference(compose(map, undone), there, 5, unit) < 1e-10);
        // The reversed path has reversed cosines: (x, -d) at input and output.
        LensWay back = way;
        back.path = straight_path(int(lens.surfaces.size()), false);
        std::swap(back.start_z, back.end_z);
        back.about = map.image();
        for (int v : {2, 3}) back.about[v] = -back.about[v];
        const RayMap behind = expansion(tracer, back, 5);
        RayNumbers in = undone.origin;
        for (int v = 0; v < 4; ++v) in[v] += 0.3 * unit[v];
        const RayNumbers a = undone.evaluate(in);
        in[2] = -in[2], in[3] = -in[3];
        const RayNumbers b = behind.evaluate(in);
        for (int v = 0; v < 4; ++v)
            CHECK(a[v] == doctest::Approx(v < 2 ? b[v] : -b[v]).epsilon(1e-11));
    }
}

TEST_CASE("maps are symplectic but for an error that falls as their degree says") {
    for (const Prescription& lens : {test::check_lens(true, 0.5), general_lens(false)}) {
        CAPTURE(lens.name);
        const Tracer tracer(lens);
        const bool symmetric = is_axially_symmetric(lens);
        CHECK(symplectic_error(expansion(tracer, film_way(tracer), 1), {}) < 1e-13);
        for (const int degree : {3, 4, 5}) {
            CAPTURE(degree);
            const RayMap map = expansion(tracer, film_way(tracer), degree);
            const auto error = [&](double t) {
                const RayNumbers u = units(tracer);
                return symplectic_error(
                    map, {t * u[0], -0.6 * t * u[1], 0.5 * t * u[2], t * u[3]});
            };
            const double order = std::log2(error(0.4) / error(0.2));
            CHECK(order == doctest::Approx(symmetric && degree % 2 ? degree + 1 : degree)
                               .epsilon(0.15));
        }
    }
}

TEST_CASE("ghosts: derivatives of the exact two-reflection trace, both ways") {
    const Tracer tracer(test::tessar());
    for (const auto& pair : {std::pair{0, 1}, {2, 5}, {3, 7}}) {
        for (const bool forward : {true, false}) {
            CAPTURE(pair.first);
            CAPTURE(forward);
            LensWay way = film_way(tracer);
            way.path = ghost_path(tracer, pair.second, pair.first, forward);
            if (!forward) std::swap(way.start_z, way.end_z);
            const RayMap map = expansion(tracer, way, 5);
            const double small = 0.2;
            RayNumbers unit = units(tracer);
            for (double& u : unit) u *= small;
            for (const int g : {1, 3})
                CHECK(derivative_error(tracer, way, map, g, unit) < 1e-6);
            // The ABCD matrix of a ghost has determinant 1 in each section.
            const Matrix4x4 j = map.jacobian({});
            CHECK(j[0][0] * j[2][2] - j[0][2] * j[2][0] == doctest::Approx(1));
        }
    }
    CHECK_THROWS_WITH_AS(ghost_path(tracer, 4, 1, true),
                         doctest::Contains("one medium on both sides"), Error);
    CHECK_THROWS_WITH_AS(ghost_path(tracer, 1, 1, true), doctest::Contains("twice"),
                         Error);
    CHECK_THROWS_WITH_AS(ghost_path(tracer, 8, 1, true), doctest::Contains("0 .. 7"),
                         Error);
}

TEST_CASE(
    "the iris on the way: of a ghost at each of its crossings, in the iris's own frame") {
    Prescription lens = test::tessar();
    lens.surfaces[4].decenter = {0.2, -0.1, 0}, lens.surfaces[4].tilt = {3, 5, 40};
    const Tracer tracer(lens);
    const LensIndices n = tracer.at(kDesignWavelength);
    LensWay way = film_way(tracer);
    const LensPath ghost = ghost_path(tracer, 2, 6, true);
    for (const int crossing : {0, 1, 2}) {
        way.path = path_to_stop(tracer, ghost, crossing), way.to_iris = true;
        const RayNumbers r{0.1, -0.07, 0.004, 0.006};
        const RayNumbers iris = expansion(tracer, way, 7).evaluate(r);
        TracedRay traced{{{r[0], r[1], way.start_z},
                          {r[2], r[3], std::sqrt(1 - r[2] * r[2] - r[3] * r[3])}}};
        REQUIRE(tracer.follow(traced, way.path, n, {false, nullptr, 0}) < 0);
        CHECK(iris[0] == doctest::Approx(traced.iris.x).epsilon(1e-7));
        CHECK(iris[1] == doctest::Approx(traced.iris.y).epsilon(1e-7));
        const SurfaceFrame& place = tracer.form(4).place;
        const Vec3d d =
            place.turn_in(traced.ray.direction);  // no refraction at the stop
        CHECK(iris[2] == doctest::Approx(d.x).epsilon(1e-7));
        CHECK(iris[3] == doctest::Approx(d.y).epsilon(1e-7));
    }
    CHECK(path_to_stop(tracer, ghost, -1).size() ==
          path_to_stop(tracer, ghost, 2).size());
    CHECK_THROWS_WITH_AS(path_to_stop(tracer, ghost, 3), doctest::Contains("0 to 2"),
                         Error);
}

TEST_CASE("what has no expansion is said, with its surface") {
    Prescription lens = general_lens(true);
    lens.surfaces[3].asphere = {{5, 1e-8}};
    const Tracer tracer(lens);
    LensWay way = film_way(tracer);
    CHECK_THROWS_WITH_AS(expansion(tracer, way, 3),
                         doctest::Contains("surface 3: Taylor expansion"), LensError);
    way.about = {0, 0, 0.9, 0};
    CHECK_THROWS_WITH_AS(expansion(tracer, way, 3), doctest::Contains("surface 1"),
                         LensError);
    way.about = {0, 0, 1, 0};
    CHECK_THROWS_WITH_AS(expansion(tracer, way, 3), doctest::Contains("goes forward"),
                         Error);
    way.about = {};
    CHECK_THROWS_WITH_AS(expansion(tracer, way, 0), doctest::Contains("1 to 15"), Error);
    CHECK_THROWS_WITH_AS(expansion(tracer, way, 16), doctest::Contains("1 to 15"), Error);
    CHECK_THROWS_WITH_AS(compose(propagation(1, 3, {1, 0, 0, 0}), propagation(1, 3)),
                         doctest::Contains("about the ray on which the first ends"),
                         Error);
    CHECK_THROWS_AS(refraction(SurfaceForm(Surface{}, 0), 1, -1.5, 3), Error);
}
