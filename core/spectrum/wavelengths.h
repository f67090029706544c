// wavelengths.h -- wavelengths of a path and all values that depend only on them, looked up once
// per path: matching functions, RGB basis and D65.
#pragma once
#include "spectrum/spectrum.h"

namespace dg {

inline constexpr float kMinWavelength = 380.f, kMaxWavelength = 780.f;  // nm

/// Four wavelengths in nm: the hero, and three rotated by quarters of the sampling CDF. An Rgb is
/// upsampled by three multiply-adds: the basis of Mallett and Yuksel (2019, Spectral Primary
/// Decomposition for Rendering with sRGB Reflectance) sums to 1, so a reflectance of (1,1,1) is
/// exactly 1 at every wavelength.
struct Wavelengths {
    Spectrum nm;
    Spectrum pdf;               // per nm, of each wavelength
    Spectrum red, green, blue;  // upsampling basis at nm
    Spectrum d65;  // D65 normalized to luminance(d65) = 1 (cd/m2 for Rgb 1,1,1)
    Spectrum cie_x, cie_y, cie_z;  // matching functions / (4 pdf), normalized to Y(d65) = 1
    bool secondary_ended = false;  // only the hero counts from here on

    /// Importance-samples wavelengths with u in [0,1) (see wavelengths.cpp).
    static Wavelengths sample(float u);
    /// Four independent wavelengths at given u of the table of sample(), where each u was sampled
    /// with the given density relative to uniform.
    static Wavelengths at(Spectrum u, Spectrum density);

    Spectrum reflectance(Rgb c) const { return red * c.x + green * c.y + blue * c.z; }
    Spectrum emission(Rgb c) const { return d65 * reflectance(c); }

    /// Terminates the secondary wavelengths (dispersion in the lens): the hero's weight becomes 4,
    /// the weights of the others 0. Idempotent.
    void end_secondary();

    /// Weights (nm) for estimates of an integral over wavelength; 0 for terminated wavelengths.
    Spectrum measure() const;

    /// Estimate of CIE XYZ (2 degree observer) from a sample; white is D65 with Y = 1.
    Vec3f to_xyz(Spectrum radiance) const;
};

/// Weights of a path with only the hero wavelength: each wavelength is the hero of a quarter of the
/// paths.
inline Spectrum hero_alone() {
    return {kWavelengths, 0, 0, 0};
}

/// Density per nm of Wavelengths::sample; 0 outside 380-780 nm.
float wavelength_pdf(float nm);

/// CIE tables at 5 nm, linear in between; 0 outside 380-780 nm. Values as published: y peaks at 1,
/// D65 is 100 at 560 nm.
double cie_x(double nm), cie_y(double nm), cie_z(double nm), d65(double nm);
/// Upsampling basis at a wavelength (red, green, blue); sums to 1.
Vec3d rgb_basis(double nm);

/// 3x3 matrices consistent with the tables: XYZ of D65 is exactly Rgb (1,1,1).
Rgb rgb_from_xyz(Vec3f xyz);
Vec3f xyz_from_rgb(Rgb rgb);
inline float luminance(Rgb c) {
    return xyz_from_rgb(c).y;
}

}  // namespace dg
