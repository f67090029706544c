#include "transport/sharing/path_vertex.h"

namespace dg {
namespace {

Vec3f shading_normal(const Bsdf& bsdf) {
    return std::visit(
        [](const auto& kind) {
            if constexpr (requires { kind.base; }) return kind.base.ns;
            else return kind.ns;
        },
        bsdf);
}

/// Whether two BSDFs of one point, shaded from two directions, have equal normals. False for one-sided surfaces.
bool same_normals(const Bsdf& a, const Bsdf& b) {
    if (a.index() != b.index()) return false;
    if (!(shading_normal(a) == shading_normal(b))) return false;
    const auto* coated = std::get_if<LayeredBsdf>(&a);
    return !coated || coated->coat.ns == std::get<LayeredBsdf>(b).coat.ns;
}

/// Factor that converts the radiance weight of a delta lobe, sampled from to_light, to a flux weight.
float flux_correction(const Bsdf& bsdf, const BsdfSample& s, Vec3f to_light, Vec3f ng) {
    float factor = std::visit([&](const auto& b) { return b.reversed(to_light, s.wi); }, bsdf);
    factor *= std::abs(dot(ng, s.wi) / dot(ng, to_light));
    if (!s.transmitted || s.eta == 1) return factor;
    // n^2 |ns . w| dw is equal on both sides of the interface.
    const Vec3f ns = shading_normal(bsdf);
    return factor * s.eta * s.eta * std::abs(dot(ns, to_light) / dot(ns, s.wi));
}

}  // namespace

PathVertex::PathVertex(const Material& material, const std::vector<Texture>& textures, const SurfaceHit& hit,
               const Wavelengths& wavelengths, const Bsdf* shaded)
    : material_(material),
      textures_(textures),
      wavelengths_(wavelengths),
      hit_(hit),
      view_independent_(hit.ns == hit.ng && !has_normal_map(material) && !is_one_sided(material)),
      view_(hit.wo),
      bsdf_(shaded ? *shaded : shade_from(hit.wo)) {}

Bsdf PathVertex::shade_from(Vec3f w) const {
    SurfaceHit hit = hit_;
    hit.wo = w;
    hit.front = dot(hit.ng, w) > 0;
    if (hit.smooth) use_smooth_normal(hit);
    return shade(material_, textures_, hit, wavelengths_);
}

const Bsdf& PathVertex::seen_from(Vec3f w) {
    if (view_independent_ || w == view_) return bsdf_;
    return other_bsdf_.emplace(shade_from(w));
}

Scattering PathVertex::scattering(Vec3f to_camera, Vec3f to_light) {
    Scattering s;
    if (is_behind(to_camera, to_light)) return s;
    const Evaluation e = evaluate_with_pdf(seen_from(to_camera), to_camera, to_light);
    if (e.f_cos.is_black()) return s;
    s.f_cos = e.f_cos;
    s.camera_pdf = e.pdf;
    s.hero_only = e.hero_only;
    s.light_pdf = evaluate_with_pdf(seen_from(to_light), to_light, to_camera).pdf;
    return s;
}

bool PathVertex::reversible(Vec3f a, Vec3f b) {
    if (view_independent_) return true;
    const Bsdf first = seen_from(a);
    return same_normals(first, seen_from(b));
}

std::optional<LightStep> PathVertex::step(Vec3f to_light, float u_lobe, Vec2f u) {
    const Bsdf& bsdf = seen_from(to_light);
    const auto s = sample(bsdf, to_light, u_lobe, u);
    if (!s || s->hero_only || s->weight.is_black() || is_behind(s->wi, to_light)) return std::nullopt;
    LightStep step{.to_camera = s->wi, .specular = s->specular, .transmitted = s->transmitted};
    if (s->specular) {
        step.weight = s->weight * flux_correction(bsdf, *s, to_light, hit_.ng);
        if (!reversible(to_light, s->wi)) return std::nullopt;
        return step;
    }
    const float turned = std::abs(dot(hit_.ng, s->wi) / dot(hit_.ng, to_light));
    const Evaluation e = evaluate_with_pdf(seen_from(s->wi), s->wi, to_light);
    if (e.f_cos.is_black() || !std::isfinite(turned)) return std::nullopt;
    step.weight = e.f_cos * (turned / s->pdf);
    step.pdf = s->pdf;
    step.camera_pdf = e.pdf;
    return step;
}

}  // namespace dg
