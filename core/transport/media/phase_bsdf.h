// phase_bsdf.h -- adapts a phase function to the BSDF interface, so that media and surfaces share the code that
// scatters a path. There is no cosine factor and no transmission.
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
