// bsdf_sample.h -- results of BSDFs, interiors, and the side of the surface from which a BSDF is evaluated.
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
    float pdf = 0;  // 1/sr; for a specular direction the discrete probability
    bool specular = false;  // direction is a delta: no MIS, no light sampling
    bool transmitted = false;
    float eta =
        1;  // relative index of a refraction (Russian roulette undoes the eta^2 scaling)
    bool hero_only = false;  // refracted by a dispersive interface: the weight is from hero_alone()
};

/// Value and density of a pair of directions, both without delta lobes.
struct Evaluation {
    Spectrum f_cos{0.f};  // f * |cos wi|
    float pdf = 0;        // density of sample(), 1/sr
    bool hero_only = false;  // as in BsdfSample
};

/// The volume or medium behind a surface: its absorption, with the transmittance `color` over `distance` metres, or a
/// participating medium.
struct Interior {
    bool present = false;   // absorbs, by color and distance
    Spectrum color{1.f};
    float distance = 1;
    const Medium* medium = nullptr;      // participating medium; null: none
    std::uint32_t instance = kWorld;     // instance that defines the space of the medium's grid
    static constexpr std::uint32_t kWorld = 0xffffffffu;

    /// Beer-Lambert transmittance over `length` metres.
    Spectrum transmittance(float length) const {
        return present ? pow(color, length / distance) : Spectrum(1.f);
    }
};

/// Interior behind a surface that is hit inside `here`. A thin sheet inside a volume does not change it.
inline Interior medium_beyond(const Interior& here, const Interior& inside,
                              bool bounds_volume, bool entering) {
    if (!bounds_volume) return here;
    return entering ? inside : Interior{};
}

/// Both normals, flipped to the side of wo. The geometric normal distinguishes reflection from transmission, which
/// prevents light leaks through bumped surfaces; the shading normal is used for cosines.
struct Facing {
    Vec3f ns, ng;
    float cos_o;
    bool front;  // wo is on the side of the original normals

    Facing(Vec3f shading, Vec3f geometric, Vec3f wo) {
        front = dot(geometric, wo) >= 0;
        ns = front ? shading : -shading;
        ng = front ? geometric : -geometric;
        cos_o = dot(ns, wo);
    }
    bool reflects(Vec3f wi) const { return dot(ng, wi) > 0; }
};

/// GGX lobes with a lower alpha are delta lobes: a float half vector cannot resolve their peak, 1 / (pi alpha^2).
inline constexpr float kSmoothAlpha = 1e-3f;

}  // namespace dg
