// responses_test.cpp -- interpolation of curves, and convergence of estimates to integrals.
#include "spectrum/responses.h"

#include <doctest/doctest.h>

#include <limits>

#include "math/error.h"

using namespace dg;

namespace {

constexpr int kNodes = Responses::kNodes;

/// Colour matching functions normalized to 1 for D65 of luminance 1, and a triangular peak with a
/// base of 3 nm.
std::vector<double> curves() {
    std::vector<double> rows(4 * kNodes);
    double light[3] = {};
    for (int i = 0; i < kNodes; ++i) {
        const double nm = 380 + i;
        const double cie[3] = {cie_x(nm), cie_y(nm), cie_z(nm)};
        for (int c = 0; c < 3; ++c) rows[c * kNodes + i] = cie[c];
    }
    const int fine = 40000;
    const double d65_scale = double(Wavelengths::sample(0.5f).d65[0]) / d65(Wavelengths::sample(0.5f).nm[0]);
    for (int i = 0; i < fine; ++i) {
        const double nm = 380 + 400 * (i + 0.5) / fine, l = d65_scale * d65(nm) * 400 / fine;
        light[0] += l * cie_x(nm), light[1] += l * cie_y(nm), light[2] += l * cie_z(nm);
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kNodes; ++i) rows[c * kNodes + i] /= light[c];
    rows[3 * kNodes + 200] = 1;
    return rows;
}

}  // namespace

TEST_CASE("curves are linear between their values and end where the wavelengths do") {
    const Responses r(curves());
    CHECK(r.count() == 4);
    CHECK(r.at(580)[3] == 1);
    CHECK(r.at(580.25f)[3] == doctest::Approx(0.75));
    CHECK(r.at(579.5f)[3] == doctest::Approx(0.5));
    CHECK(r.at(581)[3] == 0);
    CHECK(r.at(780)[1] == doctest::Approx(curves()[2 * kNodes - 1]));
    CHECK(std::isfinite(r.at(781)[1]));
}

TEST_CASE("channels of colour matching curves are XYZ, sample by sample") {
    const Responses r(curves());
    const Vec3f white = xyz_from_rgb({1, 1, 1});
    for (int i = 0; i < 200; ++i) {
        Wavelengths w = Wavelengths::sample((i + 0.5f) / 200);
        if (i % 3 == 0) w.end_secondary();
        const Spectrum light = w.emission({0.2f * float(i % 7), 0.9f, 0.1f * float(i % 5)});
        const Spectrum found = r.of(w, light);
        const Vec3f xyz = w.to_xyz(light);
        for (int c = 0; c < 3; ++c) CHECK(found[c] == doctest::Approx(xyz[c] / white[c]).epsilon(2e-5));
    }
}

TEST_CASE("the mean over samples is the integral of light times curve") {
    const Responses r(curves());
    const int n = 1 << 18;
    double sum[4] = {};
    for (int i = 0; i < n; ++i) {
        const Wavelengths w = Wavelengths::sample((i + 0.5f) / n);
        const Spectrum found = r.of(w, w.d65);
        for (int c = 0; c < 4; ++c) sum[c] += found[c] / n;
    }
    for (int c = 0; c < 3; ++c) CHECK(sum[c] == doctest::Approx(1).epsilon(1e-4));
    const double d65_scale = double(Wavelengths::sample(0.5f).d65[0]) / d65(Wavelengths::sample(0.5f).nm[0]);
    CHECK(sum[3] == doctest::Approx(d65_scale * d65(580)).epsilon(2e-3));   // a triangle of area 1 nm
}

TEST_CASE("what are no curves is refused") {
    std::vector<double> rows(kNodes, 0.5);
    CHECK_THROWS_AS(Responses(std::span(rows).first(400)), Error);
    CHECK_THROWS_AS(Responses(std::span<const double>()), Error);
    CHECK_THROWS_AS(Responses(std::vector<double>(5 * kNodes, 0.5)), Error);
    rows[7] = -1e-3;
    CHECK_THROWS_AS(Responses(std::span<const double>(rows)), Error);
    rows[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(Responses(std::span<const double>(rows)), Error);
}
