// thin_film.h -- thin-film interference, exact at each wavelength of the path. The film is clear and the base has a
// real index, so the sum over all bounces in the film is Airy's formula: R = (a^2 + b^2 + 2 a b cos d) / (1 + a^2 b^2 +
// 2 a b cos d) for each polarisation, with the amplitudes a, b of the two faces and d = 4 pi n thickness cos /
// wavelength. The signs of a and b account for phase jumps. Sources: Born and Wolf, 7.6.1; Belcour and Barla 2017, A
// Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence, eq. 2-4. For a thickness of 0, or a
// film with the index of the medium above, this is the Fresnel reflectance of the base.
#pragma once
#include <algorithm>
#include <cmath>

#include "spectrum/spectrum.h"

namespace dg {

inline Spectrum abs(Spectrum a) {
    return {std::abs(a[0]), std::abs(a[1]), std::abs(a[2]), std::abs(a[3])};
}

/// Index of a clear base with the reflectance f0 in air at normal incidence; KHR_materials_iridescence uses it for
/// metals, too.
inline Spectrum index_of_f0(Spectrum f0) {
    for (int i = 0; i < kWavelengths; ++i) f0.set(i, std::clamp(f0[i], 0.f, 0.9999f));
    const Spectrum r = sqrt(f0);
    return (1 + r) / (1 - r);
}

struct ThinFilm {
    float ior = 1.3f, thickness = 0;  // nm
    float outside = 1;                // index above the film: air, or a clear coat
    Spectrum wavelengths{550.f};      // nm

    /// Reflectance for light from air at the cosine cos_o.
    Spectrum reflectance(float cos_o, Spectrum base_ior) const {
        const Faces f(*this, cos_o, base_ior);
        const Spectrum d = (4 * kPi * ior * thickness * f.cos_film) / wavelengths;
        const Spectrum two_cos{2 * std::cos(d[0]), 2 * std::cos(d[1]), 2 * std::cos(d[2]),
                               2 * std::cos(d[3])};
        return 0.5f * (airy(f.s_top, f.s_base, two_cos) + airy(f.p_top, f.p_base, two_cos));
    }
    /// Upper bound of the reflectance over thicknesses and wavelengths.
    Spectrum envelope(float cos_o, Spectrum base_ior) const {
        const Faces f(*this, cos_o, base_ior);
        return 0.5f * (airy(std::abs(f.s_top), abs(f.s_base), 2.f) +
                       airy(std::abs(f.p_top), abs(f.p_base), 2.f));
    }

  private:
    /// Fresnel amplitudes of the two faces; sin / index is the same in every layer.
    struct Faces {
        float s_top, p_top, cos_film;
        Spectrum s_base, p_base;
        Faces(const ThinFilm& t, float cos_o, Spectrum base_ior) {
            const float sin2 = std::max(0.f, 1 - cos_o * cos_o);
            const auto inside = [&](float n) {
                return std::sqrt(std::max(1e-8f, 1 - sin2 / (n * n)));
            };
            const float cos_top = inside(t.outside);
            cos_film = inside(t.ior);
            Spectrum cos_base;
            for (int i = 0; i < kWavelengths; ++i) cos_base.set(i, inside(base_ior[i]));
            s_top = ratio(t.outside * cos_top, t.ior * cos_film);
            p_top = ratio(t.ior * cos_top, t.outside * cos_film);
            s_base = ratio(Spectrum(t.ior * cos_film), base_ior * cos_base);
            p_base = ratio(base_ior * cos_film, t.ior * cos_base);
        }
    };
    template <typename T>
    static T ratio(T a, T b) {
        return (a - b) / (a + b);
    }
    static Spectrum airy(float a, Spectrum b, Spectrum two_cos) {
        const Spectrum ab = a * b, middle = ab * two_cos;
        // Rounding may cause 0/0 if both faces have a reflectance of 1.
        const Spectrum above = a * a + b * b + middle, below = 1 + ab * ab + middle;
        Spectrum r;
        for (int i = 0; i < kWavelengths; ++i)
            r.set(i, std::clamp(above[i] / std::max(below[i], 1e-9f), 0.f, 1.f));
        return r;
    }
};

/// Smallest F0 for which Schlick's curve with F90 = 1 bounds the film's reflectance at every angle. With it the albedo
/// table of GGX bounds the albedo with a film.
inline float schlick_bound(const ThinFilm& film, Spectrum base_ior) {
    float f0 = 0;
    for (const float c : {1.f, 0.8f, 0.65f, 0.5f, 0.4f, 0.3f, 0.2f, 0.1f}) {
        const float m = 1 - c, s = m * m * m * m * m;
        f0 = std::max(f0, (film.envelope(c, base_ior).max() - s) / (1 - s));
    }
    return std::min(f0, 1.f);
}

}  // namespace dg
