// spectrum.h -- a value at the four wavelengths of a path.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace dg {

/// RGB triples are linear Rec.709 / sRGB primaries, D65 white.
using Rgb = Vec3f;

inline constexpr int kWavelengths = 4;  // hero first, then three rotated from it

struct Spectrum {
    using Lanes [[gnu::vector_size(16)]] = float;
    Lanes v{};

    Spectrum() = default;
    constexpr Spectrum(float s) : v{s, s, s, s} {}  // NOLINT: a number is a constant spectrum
    constexpr Spectrum(float a, float b, float c, float d) : v{a, b, c, d} {}
    static Spectrum from(Lanes l) { Spectrum s; s.v = l; return s; }

    float operator[](int i) const { return v[i]; }
    void set(int i, float value) { v[i] = value; }
    friend Spectrum operator+(Spectrum a, Spectrum b) { return from(a.v + b.v); }
    friend Spectrum operator-(Spectrum a, Spectrum b) { return from(a.v - b.v); }
    friend Spectrum operator*(Spectrum a, Spectrum b) { return from(a.v * b.v); }
    friend Spectrum operator*(Spectrum a, float s) { return from(a.v * s); }
    friend Spectrum operator*(float s, Spectrum a) { return from(a.v * s); }
    friend Spectrum operator/(Spectrum a, Spectrum b) { return from(a.v / b.v); }
    friend Spectrum operator/(Spectrum a, float s) { return from(a.v * (1.f / s)); }
    Spectrum& operator+=(Spectrum b) { v += b.v; return *this; }
    Spectrum& operator*=(Spectrum b) { v *= b.v; return *this; }
    Spectrum& operator*=(float s) { v *= s; return *this; }

    float max() const { return std::max(std::max(v[0], v[1]), std::max(v[2], v[3])); }
    float average() const { return 0.25f * (v[0] + v[1] + v[2] + v[3]); }
    bool is_black() const { return max() <= 0 && min() >= 0; }
    float min() const { return std::min(std::min(v[0], v[1]), std::min(v[2], v[3])); }
};

inline Spectrum lerp(float t, Spectrum a, Spectrum b) { return a + (b - a) * t; }
inline Spectrum pow(Spectrum a, float e) {
    return {std::pow(a[0], e), std::pow(a[1], e), std::pow(a[2], e), std::pow(a[3], e)};
}
inline Spectrum sqrt(Spectrum a) {
    return {std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
inline Spectrum exp(Spectrum a) {
    return {std::exp(a[0]), std::exp(a[1]), std::exp(a[2]), std::exp(a[3])};
}

}  // namespace dg
