// bsdf_sample.h -- what every BSDF hands back, and the side of the surface that it is
// seen from.
#pragma once
#include <cmath>
#include <cstdint>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace dg {

struct Medium;   // medium/medium.h

struct BsdfSample {
    Vec3f wi;
    Spectrum weight{0.f};  // f * |cos| / pdf
    float pdf = 0;  // solid angle; for a specular direction the discrete probability
    bool specular = false;  // direction is a delta: no MIS, no light sampling
    bool transmitted = false;
    float eta =
        1;  // relative index change of a refraction (for Russian roulette: eta^2 scaling)
    bool hero_only = false;  // bent by a dispersive interface: weight is hero_alone()'s
};

/// Value and density of one pair of directions; delta lobes count in neither.
struct Evaluation {
    Spectrum f_cos{0.f};  // f * |cos wi|
    float pdf = 0;        // of sample(), solid angle
    bool hero_only = false;  // as in BsdfSample
};

/// Absorption of the medium behind the surface: spectral transmittance over `distance`
/// metres is transmittance_per_distance ^ (distance / attenuation_distance).
struct Interior {
    bool present = false;
    Spectrum color{1.f};
    float distance = 1;
    const Medium* medium = nullptr;      // scatters and absorbs as well
    std::uint32_t instance = kWorld;     // in whose space a grid of the medium lies
    static constexpr std::uint32_t kWorld = 0xffffffffu;

    /// Beer-Lambert over `length` metres; `color` is what is left after `distance`
    /// metres.
    Spectrum transmittance(float length) const {
        return present ? pow(color, length / distance) : Spectrum(1.f);
    }
};

/// Medium behind a surface that is met in the medium `here`. A thin sheet inside a
/// volume bounds nothing.
inline Interior medium_beyond(const Interior& here, const Interior& inside,
                              bool bounds_volume, bool entering) {
    if (!bounds_volume) return here;
    return entering ? inside : Interior{};
}

/// Both normals turned to the side of wo. The geometric normal decides what is reflection
/// and what is transmission (no light leaks through a bumped surface); the shading normal
/// gives the cosines.
struct Facing {
    Vec3f ns, ng;
    float cos_o;
    bool front;  // wo is on the side of the normals as they were given

    Facing(Vec3f shading, Vec3f geometric, Vec3f wo) {
        front = dot(geometric, wo) >= 0;
        ns = front ? shading : -shading;
        ng = front ? geometric : -geometric;
        cos_o = dot(ns, wo);
    }
    bool reflects(Vec3f wi) const { return dot(ng, wi) > 0; }
};

/// GGX lobes narrower than this are perfect mirrors and windows: their peak, 1 / (pi
/// alpha^2), would stand above what a float half vector resolves.
inline constexpr float kSmoothAlpha = 1e-3f;

}  // namespace dg
