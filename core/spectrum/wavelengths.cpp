// wavelengths.cpp -- spectral tables, wavelength sampling and colour matrices.
//
// All tables are piecewise linear over nodes 5 nm apart. A product of three tables is thus a cubic
// per interval, which Simpson's rule integrates exactly: matrices, basis and sampled estimates
// agree to rounding. Wavelengths are sampled by a table of quantiles: cell i of 512 in u maps
// linearly to [quantile i, quantile i + 1], with the exact density 1 / (512 width).
#include "spectrum/wavelengths.h"

#include <array>
#include <cstring>

#include "math/below_one.h"
#include "spectrum/tables.inc"

namespace dg {
namespace {

constexpr int kNodes = 81, kCells = 512;
constexpr double kStepNm = 5;

using Mat3 = std::array<Vec3d, 3>;  // rows

constexpr double product_integral(const double* a, const double* b) {
    double sum = 0;
    for (int i = 0; i + 1 < kNodes; ++i)
        sum += a[i] * b[i] + (a[i] + a[i + 1]) * (b[i] + b[i + 1]) + a[i + 1] * b[i + 1];
    return sum * kStepNm / 6;
}

constexpr std::array<double, kNodes> kOne = [] {
    std::array<double, kNodes> one{};
    for (double& v : one) v = 1;
    return one;
}();

constexpr double kLuma = product_integral(kCieY, kOne.data());
/// D65 is normalized to a mean of 1 under y, the matching functions to an integral of 1 for y, so
/// that Y(d65) = 1.
constexpr double kD65Scale = kLuma / product_integral(kCieY, kD65);
constexpr double kCieScale = 1 / kLuma;

/// Table entry of a node; two loads of four floats.
struct alignas(32) Node {
    float cie_d65[4];  // x, y, z over 4 wavelengths; d65
    float basis[4];    // red, green, -, -
};

constexpr std::array<Node, kNodes> kTable = [] {
    std::array<Node, kNodes> table{};
    const double c = kCieScale / kWavelengths;
    for (int i = 0; i < kNodes; ++i)
        table[i] = {{float(kCieX[i] * c), float(kCieY[i] * c), float(kCieZ[i] * c),
                     float(kD65[i] * kD65Scale)},
                    {float(kRed[i]), float(kGreen[i]), 0, 0}};
    return table;
}();

Spectrum::Lanes load(const float* four) {
    Spectrum::Lanes lanes;
    std::memcpy(&lanes, four, sizeof lanes);
    return lanes;
}

/// Interpolates four columns of the table, at t from one node to the next.
Spectrum::Lanes blend(const float* a, const float* b, float t) {
    const Spectrum::Lanes low = load(a);
    return low + (load(b) - low) * t;
}

constexpr std::array<float, kCells + 1> kQuantile = [] {
    std::array<float, kCells + 1> q{};
    for (int i = 0; i <= kCells; ++i) q[i] = float(kQuantileNm[i]);
    return q;
}();

double interpolate(const double* table, double nm) {
    if (!(nm >= kMinWavelength && nm <= kMaxWavelength)) return 0;
    const double x = (nm - kMinWavelength) / kStepNm;
    const int i = std::min(int(x), kNodes - 2);
    return table[i] + (table[i + 1] - table[i]) * (x - i);
}

/// Looks up all tables for lane k; inverse_pdf belongs to its wavelength.
void look_up(Wavelengths& w, int k, float nm, float inverse_pdf) {
    const float x = (nm - kMinWavelength) * float(1 / kStepNm);
    const int i = std::min(int(x), kNodes - 2);
    const float t = x - float(i);
    const Node &a = kTable[i], &b = kTable[i + 1];
    const Spectrum::Lanes cie = blend(a.cie_d65, b.cie_d65, t);
    const Spectrum::Lanes basis = blend(a.basis, b.basis, t);
    // Clamp to [0, 1 - red] and compute blue as the rest, so that the three sum to exactly 1 in
    // float too.
    const float red = std::min(basis[0], 1.f), green = std::min(basis[1], 1 - red);
    w.nm.v[k] = nm;
    w.pdf.v[k] = 1 / inverse_pdf;
    w.red.v[k] = red;
    w.green.v[k] = green;
    w.blue.v[k] = 1 - (red + green);
    w.d65.v[k] = cie[3];
    w.cie_x.v[k] = cie[0] * inverse_pdf;
    w.cie_y.v[k] = cie[1] * inverse_pdf;
    w.cie_z.v[k] = cie[2] * inverse_pdf;
}

Vec3d solve(const Mat3& m, Vec3d b) {
    const Vec3d c0{m[0].x, m[1].x, m[2].x}, c1{m[0].y, m[1].y, m[2].y},
        c2{m[0].z, m[1].z, m[2].z};
    const double s = 1 / dot(c0, cross(c1, c2));
    return {dot(b, cross(c1, c2)) * s, dot(b, cross(c2, c0)) * s,
            dot(b, cross(c0, c1)) * s};
}

/// Rec.709 primaries (ITU-R BT.709-6, table 1.3), scaled so that they sum to the white of our
/// tables.
struct Matrices {
    Mat3 xyz_from_rgb, rgb_from_xyz;

    Matrices() {
        const double scale = kCieScale * kD65Scale;
        const Vec3d white{product_integral(kCieX, kD65) * scale, 1,
                          product_integral(kCieZ, kD65) * scale};
        const Vec2d xy[3] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
        const Mat3 unit{Vec3d{xy[0].x / xy[0].y, xy[1].x / xy[1].y, xy[2].x / xy[2].y},
                        {1, 1, 1},
                        {(1 - xy[0].x) / xy[0].y - 1, (1 - xy[1].x) / xy[1].y - 1,
                         (1 - xy[2].x) / xy[2].y - 1}};
        const Vec3d strength = solve(unit, white);
        for (int i = 0; i < 3; ++i) xyz_from_rgb[i] = unit[i] * strength;
        const Vec3d c[3] = {solve(xyz_from_rgb, {1, 0, 0}),
                            solve(xyz_from_rgb, {0, 1, 0}),
                            solve(xyz_from_rgb, {0, 0, 1})};
        // Scale rows by about 1e-8, so that the white rounded to float maps to exactly 1.
        const Vec3d rounded = to_double(to_float(white));
        for (int i = 0; i < 3; ++i) {
            const Vec3d row{c[0][i], c[1][i], c[2][i]};
            rgb_from_xyz[i] = row * (1 / dot(row, rounded));
        }
    }
};

const Matrices kMatrices;

Vec3f times(const Mat3& m, Vec3f v) {
    const Vec3d d = to_double(v);
    return {float(dot(m[0], d)), float(dot(m[1], d)), float(dot(m[2], d))};
}

}  // namespace

Wavelengths Wavelengths::sample(float u) {
    const float scaled = std::clamp(u, 0.f, kBelowOne) * kCells;
    const int first = int(scaled);
    const float t = scaled - float(first);
    Wavelengths w;
    for (int k = 0; k < kWavelengths; ++k) {
        const int cell = (first + k * (kCells / kWavelengths)) % kCells;
        const float width = kQuantile[cell + 1] - kQuantile[cell];
        look_up(w, k, kQuantile[cell] + width * t, width * kCells);
    }
    return w;
}

Wavelengths Wavelengths::at(Spectrum u, Spectrum density) {
    Wavelengths w;
    for (int k = 0; k < kWavelengths; ++k) {
        const float scaled = std::clamp(u[k], 0.f, kBelowOne) * kCells;
        const int cell = int(scaled);
        const float width = kQuantile[cell + 1] - kQuantile[cell];
        look_up(w, k, kQuantile[cell] + width * (scaled - float(cell)), width * kCells / density[k]);
    }
    return w;
}

void Wavelengths::end_secondary() {
    if (secondary_ended) return;
    secondary_ended = true;
    cie_x *= hero_alone();
    cie_y *= hero_alone();
    cie_z *= hero_alone();
}

Spectrum Wavelengths::measure() const {
    const Spectrum share = secondary_ended ? hero_alone() : Spectrum(1.f);
    return Spectrum::from(share.v / (pdf.v * float(kWavelengths)));
}

Vec3f Wavelengths::to_xyz(Spectrum radiance) const {
    const auto sum = [](Spectrum s) { return (s[0] + s[1]) + (s[2] + s[3]); };
    return {sum(cie_x * radiance), sum(cie_y * radiance), sum(cie_z * radiance)};
}

float wavelength_pdf(float nm) {
    if (!(nm >= kMinWavelength && nm <= kMaxWavelength)) return 0;
    const auto above = std::upper_bound(kQuantile.begin() + 1, kQuantile.end() - 1, nm);
    return 1 / ((above[0] - above[-1]) * kCells);
}

double cie_x(double nm) {
    return interpolate(kCieX, nm);
}
double cie_y(double nm) {
    return interpolate(kCieY, nm);
}
double cie_z(double nm) {
    return interpolate(kCieZ, nm);
}
double d65(double nm) {
    return interpolate(kD65, nm);
}

Vec3d rgb_basis(double nm) {
    const double clamped = std::clamp<double>(nm, kMinWavelength, kMaxWavelength);
    const double red = interpolate(kRed, clamped), green = interpolate(kGreen, clamped);
    return {red, green, 1 - red - green};
}

Rgb rgb_from_xyz(Vec3f xyz) {
    return times(kMatrices.rgb_from_xyz, xyz);
}
Vec3f xyz_from_rgb(Rgb rgb) {
    return times(kMatrices.xyz_from_rgb, rgb);
}

}  // namespace dg
