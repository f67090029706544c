// bsdf.h -- the variant of all BSDFs. bsdf_kind.h defines the interface of an alternative, and how to add a BSDF.
#pragma once
#include <variant>

#include "material/bsdf_coated.h"
#include "material/bsdf_conductor.h"
#include "material/bsdf_dielectric.h"
#include "material/bsdf_diffuse.h"
#include "material/bsdf_glass.h"
#include "material/bsdf_gltf.h"
#include "material/bsdf_kind.h"
#include "material/bsdf_layered.h"
#include "material/bsdf_metal.h"
#include "material/bsdf_sample.h"
#include "material/bsdf_translucent.h"

namespace dg {

/// A BSDF at a hit for the wavelengths of a path; a small value type.
using Bsdf =
    std::variant<DiffuseBsdf, ConductorBsdf, DielectricBsdf, GltfBsdf, LayeredBsdf, TranslucentBsdf,
                 MetalBsdf, GlassBsdf, CoatedBsdf>;

template <typename Kinds>
inline constexpr bool kBsdfKinds = false;
template <BsdfKind... Kinds>
inline constexpr bool kBsdfKinds<std::variant<Kinds...>> = true;
static_assert(kBsdfKinds<Bsdf>);

/// Argument for wo in evaluate_with_pdf() and sample() if several wi follow: some BSDFs precompute values of wo.
template <Scatters B>
auto seen_from(const B& bsdf, Vec3f wo) {
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
