// wavelengths.h -- the wavelengths of one path and everything that depends on them alone,
// looked up once per path: colour matching weights, the RGB basis and the D65 shape.
#pragma once
#include "spectrum/spectrum.h"

namespace dg {

inline constexpr float kMinWavelength = 380.f, kMaxWavelength = 780.f;  // nm

/// Four wavelengths in nm: hero first, the others rotated by quarters of the sampling
/// CDF. An Rgb becomes a spectrum by three multiply-adds: the basis of Mallett and Yuksel
/// (2019, Spectral Primary Decomposition for Rendering with sRGB Reflectance) sums to 1,
/// so that a reflectance of (1,1,1) stays exactly 1 at every wavelength.
struct Wavelengths {
    Spectrum nm;
    Spectrum pdf;               // of each wavelength, per nm
    Spectrum red, green, blue;  // basis of the upsampling at nm
    Spectrum d65;  // D65 shape, scaled so that luminance(d65) = 1 (cd/m2 for Rgb 1,1,1)
    Spectrum cie_x, cie_y, cie_z;  // colour matching / (4 pdf), scaled so that Y(d65) = 1
    bool secondary_ended = false;  // only the hero counts from here on

    /// u in [0,1); importance sampled (see wavelengths.cpp).
    static Wavelengths sample(float u);
    /// Four of their own: each at its u of the table that sample() draws by, together drawn over the u with so
    /// many times the even density.
    static Wavelengths at(Spectrum u, Spectrum density);

    Spectrum reflectance(Rgb c) const { return red * c.x + green * c.y + blue * c.z; }
    Spectrum emission(Rgb c) const { return d65 * reflectance(c); }

    /// Only the hero wavelength is followed (dispersion in the lens): its weight becomes 4,
    /// the others 0. Idempotent.
    void end_secondary();

    /// Weights (nm) of an estimate of the integral over wavelengths; 0 for those that have ended.
    Spectrum measure() const;

    /// One sample's estimate of CIE XYZ (2 degree), white = D65 with Y = 1.
    Vec3f to_xyz(Spectrum radiance) const;
};

/// Weights of a path that goes on with the hero alone: each wavelength is the hero of one
/// path in four.
inline Spectrum hero_alone() {
    return {kWavelengths, 0, 0, 0};
}

/// Density per nm of Wavelengths::sample; 0 outside 380-780 nm.
float wavelength_pdf(float nm);

/// Tabulated at 5 nm, linear between; zero outside 380-780 nm.
/// CIE values as published: y peaks at 1, D65 is 100 at 560 nm.
double cie_x(double nm), cie_y(double nm), cie_z(double nm), d65(double nm);
/// Basis of the upsampling at one wavelength (red, green, blue); sums to 1.
Vec3d rgb_basis(double nm);

/// 3x3 matrices consistent with the tables: XYZ of D65 is exactly Rgb (1,1,1).
Rgb rgb_from_xyz(Vec3f xyz);
Vec3f xyz_from_rgb(Rgb rgb);
inline float luminance(Rgb c) {
    return xyz_from_rgb(c).y;
}

}  // namespace dg
