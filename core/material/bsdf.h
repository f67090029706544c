// bsdf.h -- scattering at a point. Directions are unit, in the WORLD frame, both pointing away from
// the surface. A BSDF is a small value that lives for one bounce.
#pragma once
#include <optional>
#include <variant>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace dg {

struct BsdfSample {
    Vec3f wi;
    Spectrum weight;        // f * |cos| / pdf
    float pdf = 0;          // solid angle; for a specular direction the discrete probability
    bool specular = false;  // direction is a delta: no MIS, no light sampling
    bool transmitted = false;
    float eta = 1;          // relative index change of a refraction (for Russian roulette: eta^2 scaling)
};

/// Absorption of the medium behind the surface: spectral transmittance over `distance` metres is
/// transmittance_per_distance ^ (distance / attenuation_distance).
struct Interior {
    bool present = false;
    Spectrum color{1.f};
    float distance = 1;
};

}  // namespace dg

#include "material/bsdf_conductor.h"
#include "material/bsdf_dielectric.h"
#include "material/bsdf_diffuse.h"
#include "material/bsdf_gltf.h"

namespace dg {

/// Each alternative has: Spectrum evaluate(wo, wi) const (f * |cos wi|, 0 for delta lobes);
/// float pdf(wo, wi) const; optional<BsdfSample> sample(wo, u_lobe, u) const; bool is_specular() const
/// (nothing but deltas); Interior interior() const.
using Bsdf = std::variant<DiffuseBsdf, ConductorBsdf, DielectricBsdf, GltfBsdf>;

}  // namespace dg
