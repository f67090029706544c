// phase_bsdf.h -- a medium's phase function in the form of a BSDF, so that a path is scattered in a medium as it is at
// a surface. There is no cosine, and no side that light passes to.
#pragma once
#include <optional>

#include "material/bsdf_kind.h"
#include "medium/phase.h"

namespace dg {

struct PhaseBsdf {
    const Phase& phase;

    static constexpr bool kInMedium = true;
    static constexpr bool kOneLobe = false;
    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const float value = phase.value(wo, wi);
        return {value, value};
    }
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const {
        const Vec3f wi = phase.sample(wo, u_lobe, u);
        return BsdfSample{.wi = wi, .weight = 1.f, .pdf = phase.value(wo, wi)};
    }
    bool is_specular() const { return false; }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    float diffuse_share(Vec3f, Vec3f) const { return 1; }
};
static_assert(PhaseKind<PhaseBsdf>);

}  // namespace dg
