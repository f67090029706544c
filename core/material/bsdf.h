// bsdf.h -- scattering at a point. Directions are unit, in the WORLD frame, both pointing
// away from the surface. A BSDF is a small value that lives for one bounce.
#pragma once
#include <variant>

#include "material/bsdf_coated.h"
#include "material/bsdf_conductor.h"
#include "material/bsdf_dielectric.h"
#include "material/bsdf_diffuse.h"
#include "material/bsdf_glass.h"
#include "material/bsdf_gltf.h"
#include "material/bsdf_layered.h"
#include "material/bsdf_metal.h"
#include "material/bsdf_sample.h"
#include "material/bsdf_translucent.h"

namespace dg {

/// Each alternative has: Evaluation evaluate_with_pdf(wo, wi) const (f * |cos wi| and the
/// density of sample(), both without delta lobes) and its halves Spectrum evaluate(wo,
/// wi) const and float pdf(wo, wi) const; optional<BsdfSample> sample(wo, u_lobe, u)
/// const; bool is_specular() const (nothing but deltas); Interior interior() const; bool
/// bounds_volume() const (behind it lies another medium); Spectrum straight(wo) const
/// (share of light that a smooth clear surface lets through unbent; where it bounds a
/// volume, as if light went on without being bent: both faces of a plane slab have the
/// Fresnel reflectance of the angle outside); float reversed(wo, wi) const (what a delta
/// lobe from wi to wo has, 1 / eta^2 aside, over the same from wo to wi); float diffuse_share(wo,
/// wi) const (of f that is not delta, 0 to 1).
using Bsdf =
    std::variant<DiffuseBsdf, ConductorBsdf, DielectricBsdf, GltfBsdf, LayeredBsdf, TranslucentBsdf,
                 MetalBsdf, GlassBsdf, CoatedBsdf>;

/// A BSDF as it looks from wo, for whoever asks for several wi: some know things of wo that take a while to find.
/// To be given to evaluate_with_pdf() and sample() in place of wo.
template <typename BsdfKind>
auto seen_from(const BsdfKind& bsdf, Vec3f wo) {
    if constexpr (requires { bsdf.seen_from(wo); })
        return bsdf.seen_from(wo);
    else
        return wo;
}

inline Evaluation evaluate_with_pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi) {
    return std::visit([&](const auto& b) { return b.evaluate_with_pdf(wo, wi); }, bsdf);
}
inline std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3f wo, float u_lobe,
                                        Vec2f u) {
    return std::visit([&](const auto& b) { return b.sample(wo, u_lobe, u); }, bsdf);
}
inline bool is_specular(const Bsdf& bsdf) {
    return std::visit([](const auto& b) { return b.is_specular(); }, bsdf);
}
inline Interior interior(const Bsdf& bsdf) {
    return std::visit([](const auto& b) { return b.interior(); }, bsdf);
}

}  // namespace dg
