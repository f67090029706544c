// Surfaces known to image without aberration, and the astigmatism of others.
#include <doctest/doctest.h>

#include "math/linear_solve.h"
#include "optics/first_order/paraxial.h"
#include "optics/lens/form.h"
#include "optics/lens/test_lenses.h"
#include "optics/trace/trace.h"

using namespace dg;

namespace {

/// Single surface between two media, which is also the stop.
Prescription boundary(const Surface& surface, double before, double after) {
    Prescription lens;
    lens.name = "boundary";
    lens.object_medium.formula = ConstantIndex{before};
    lens.surfaces = {surface};
    lens.surfaces[0].glass.formula = ConstantIndex{after};
    lens.surfaces[0].stop = true;
    lens.surfaces[0].thickness = 100;
    return lens;
}

/// Largest distance in mm between the focus and rays that arrive parallel to the axis, and the
/// spread of their optical paths up to it.
struct Focus {
    double miss = 0, path_spread = 0;
    int rays = 0;
};

Focus from_infinity(const Prescription& lens, double focus_z, double height) {
    const Tracer t(lens);
    const LensIndices n = t.at(550);
    Focus f;
    double shortest = 1e300, longest = -1e300;
    for (int i = 1; i <= 20; ++i)
        for (double angle : {0.3, 2.0, 4.0}) {
            const double r = height * i / 20;
            const Vec3d from{r * std::cos(angle), r * std::sin(angle), -5};
            const auto out = t.to_film({from, {0, 0, 1}}, n, {false, nullptr, 0});
            if (!out) continue;
            ++f.rays;
            const Vec3d left = Vec3d{0, 0, focus_z} - out->ray.origin;
            f.miss = std::max(f.miss, length(cross(left, out->ray.direction)));
            const double path =
                out->optical_path + n.index.back() * dot(left, out->ray.direction);
            shortest = std::min(shortest, path), longest = std::max(longest, path);
        }
    f.path_spread = longest - shortest;
    return f;
}

/// Foci of rays close to a chief ray tilted in y: distances along it from the plane z, from the
/// Jacobian between that plane and the ray's start.
struct Foci {
    double tangential, sagittal;
};
Foci foci(const Prescription& lens, double field, double z) {
    const Tracer t(lens);
    const LensIndices n = t.at(kDesignWavelength);
    const Vec3d d{0, std::sin(field), std::cos(field)};
    const double pupil = first_order(lens).entrance_pupil_z;
    const LensRay chief{Vec3d{0, 0, pupil} - d * ((pupil + 20) / d.z), d};
    const auto j = t.jacobian(chief, n, z);
    REQUIRE(j);
    const auto out = t.to_film(chief, n, {false, nullptr, 0});
    const double c = out->ray.direction.z;
    // Parallel bundle: only dx at the start varies. dL at the end moves x by t / c, and y by t /
    // c^3, since dN follows dM.
    const auto& m = *j;
    return {-m[1][1] / m[3][1] * c * c, -m[0][0] / m[2][0]};
}

}  // namespace

TEST_CASE("an ellipsoid and a hyperboloid focus parallel light without error") {
    const double n = 1.6, r = 30;
    Surface s;  // into glass: eccentricity 1/n
    s.curvature = 1 / r, s.conic = -1 / (n * n);
    const Focus into = from_infinity(boundary(s, 1, n), n * r / (n - 1), 25);
    CHECK(into.rays == 60);
    CHECK(into.miss < 1e-10);
    CHECK(into.path_spread < 1e-10);
    s.curvature = -1 / r, s.conic = -n * n;  // out of glass: eccentricity n
    const Focus out = from_infinity(boundary(s, n, 1), r / (n - 1), 25);
    CHECK(out.rays == 60);
    CHECK(out.miss < 1e-10);
    CHECK(out.path_spread < 1e-10);
    // Planted faults: a conic constant off by 0.1 %; a path without the index.
    s.conic *= 1.001;
    CHECK(from_infinity(boundary(s, n, 1), r / (n - 1), 25).miss > 1e-3);
}

TEST_CASE("a Cartesian oval as an asphere images a point onto a point") {
    // n1 |P - A| + n2 |B - P| equals its value on the axis; solved by bisection and fitted by even
    // powers. A is 60 mm in front of the vertex, B 80 mm behind it.
    const double n1 = 1, n2 = 1.5, a = 60, b = 80, reach = 8;
    const auto height = [&](double r) {
        double low = -1, high = 5;
        for (int i = 0; i < 200; ++i) {
            const double z = 0.5 * (low + high);
            const double path = n1 * std::hypot(r, z + a) + n2 * std::hypot(r, b - z);
            (path > n1 * a + n2 * b ? low : high) = z;
        }
        return low;
    };
    constexpr int kTerms = 7, kNodes = 40;
    std::vector<double> matrix, rhs;
    for (int i = 1; i <= kNodes; ++i) {
        const double x = std::sin(0.5 * kPiD * i / kNodes);
        for (int j = 1; j <= kTerms; ++j) matrix.push_back(std::pow(x, 2 * j));
        rhs.push_back(height(reach * x));
    }
    const auto terms = least_squares(matrix, kNodes, kTerms, rhs, 1);
    Surface s;
    for (int j = 1; j <= kTerms; ++j)
        s.asphere.push_back({2 * j, terms[j - 1] / std::pow(reach, 2 * j)});
    const Tracer t(boundary(s, n1, n2));
    for (int i = 1; i <= 20; ++i) {
        const double angle = 0.12 * i / 20;
        const Vec3d d{std::sin(angle), 0, std::cos(angle)};
        const auto out = t.to_film({{0, 0, -a}, d}, t.at(550), {false, nullptr, 0});
        REQUIRE(out);
        CHECK(std::abs(at_plane(out->ray, b).x) < 2e-7);
    }
}

TEST_CASE("a cylinder and a toroid have foci of their own in both sections") {
    const double n = 1.5;
    Surface s;
    s.curvature = 1.0 / 40, s.curvature_x = 1.0 / 60, s.shape = Shape::toroid;
    const auto focal = [&](const Surface& surface, int axis) {
        const auto j = Tracer(boundary(surface, 1, n))
                           .jacobian({{0, 0, -1}, {0, 0, 1}},
                                     Tracer(boundary(surface, 1, n)).at(550), 0);
        return -n / (*j)[axis + 2][axis];
    };
    CHECK(focal(s, 0) == doctest::Approx(n * 60 / (n - 1)).epsilon(1e-12));
    CHECK(focal(s, 1) == doctest::Approx(n * 40 / (n - 1)).epsilon(1e-12));
    s.shape = Shape::conic;
    set_kind(s, "cyl-x");  // axis along x: power in y
    CHECK(focal(s, 1) == doctest::Approx(n * 40 / (n - 1)).epsilon(1e-12));
    CHECK(std::abs(1 / focal(s, 0)) < 1e-15);
    set_kind(s, "cyl-y");
    CHECK(focal(s, 0) == doctest::Approx(n * 40 / (n - 1)).epsilon(1e-12));
    CHECK(std::abs(1 / focal(s, 1)) < 1e-15);
}

TEST_CASE("Coddington: a symmetric lens shows astigmatism off axis, and none on it") {
    // Thin lens at its stop: the tangential and sagittal field curvatures are in the ratio (3 + 1/n)
    // to (1 + 1/n), and both foci move with the square of the field angle. Source: Kingslake and Johnson, Lens Design
    // Fundamentals, 2nd ed., 11.2.
    const double n = 1.5, f = 100, r = 2 * f * (n - 1);
    Surface front, back;
    front.curvature = 1 / r, front.stop = true, front.thickness = 1e-6;
    front.glass.formula = ConstantIndex{n};
    back.curvature = -1 / r;
    Prescription lens;
    lens.name = "thin", lens.surfaces = {front, back};
    for (double field : {0.02, 0.04}) {
        const Foci at = foci(lens, field, f);
        const double h2 = field * field * f / 2;
        CHECK(at.tangential == doctest::Approx(-h2 * (3 + 1 / n)).epsilon(0.02));
        CHECK(at.sagittal == doctest::Approx(-h2 * (1 + 1 / n)).epsilon(0.02));
    }
    for (const Prescription& real : test::all_lenses()) {
        const double z = first_order(real).back_focal_z;
        const Foci axis = foci(real, 0, z), off = foci(real, 0.2, z);
        CHECK(std::abs(axis.tangential - axis.sagittal) < 1e-9);
        CHECK(std::abs(off.tangential - off.sagittal) > 1e-3);
    }
}
