// bsdf_layered.cpp -- evaluation and sampling of coat, sheen and base together.
#include "material/bsdf_layered.h"

#include "material/baked.h"

namespace dg {
namespace {

constexpr float kBelowOne = 1 - 0x1p-24f;

}  // namespace

Evaluation Coat::evaluate_with_pdf(Vec3f ng, Vec3f wo, Vec3f wi) const {
    const Facing side(ns, ng, wo);
    const float cos_i = dot(side.ns, wi);
    if (smooth() || side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi)) return {};
    const RoundGgx ggx{alpha * alpha};
    const Facet f = reflecting_facet(side.ns, wo, wi, side.cos_o, cos_i, ggx);
    return {f.f_cos, f.pdf};
}

Sheen::Sheen(Spectrum color, float largest, float roughness)
    : color(color),
      largest(std::min(largest, 1.f)),
      alpha(charlie_alpha(roughness)),
      row(baked::charlie.row(roughness)) {}

Spectrum Sheen::evaluate(Vec3f ns, Vec3f wo, Vec3f wi, float cos_o, float cos_i) const {
    const float lambda = charlie_lambda(cos_o, alpha) + charlie_lambda(cos_i, alpha);
    const float held = std::max(1.f, std::max(row.at(cos_o), row.at(cos_i)));
    return color * (charlie_d(ns, wo + wi, alpha) / ((1 + lambda) * 4 * cos_o * held));
}

float Sheen::passed(float cos_o, float cos_i) const {
    return 1 - largest * std::max(albedo(cos_o), albedo(cos_i));
}

Spectrum LayeredBsdf::straight_transmittance(Vec3f wo) const {
    const float cos_o = dot(base.ns, wo);
    const float passed = sheen.present() ? sheen.passed(cos_o, cos_o) : 1.f;
    return base.straight_transmittance(wo) * (passed * (1 - shares(wo).coat));
}

/// The coat's share depends on wo only, and its mirror direction has the same angle.
float LayeredBsdf::reversed(Vec3f wo, Vec3f wi) const {
    const float there = 1 - shares(wo).coat;
    return there > 0 ? (1 - shares(wi).coat) / there : 0;
}

LayeredBsdf::Shares LayeredBsdf::shares(Vec3f wo) const {
    const Facing coat_side(coat.ns, base.ng, wo);
    Shares p{};
    if (coat.factor > 0 && coat_side.cos_o > 0)
        p.coat = coat_share(coat.factor, coat_side.cos_o);
    const float e = sheen.present() ? sheen.albedo(dot(base.ns, wo)) : 0.f;
    const float sheen_albedo = sheen.color.average() * e;
    const float base_albedo = base.albedo_estimate(wo) * (1 - sheen.largest * e);
    const float below = 1 - p.coat, total = p.coat + below * (sheen_albedo + base_albedo);
    if (!(total > 0)) return p;
    p.coat_probability = p.coat / total;
    p.sheen_probability = below * sheen_albedo / total;
    p.base_probability = std::max(0.f, 1 - p.coat_probability - p.sheen_probability);
    return p;
}

float LayeredBsdf::diffuse_share(Vec3f wo, Vec3f wi) const {
    const Facing side(base.ns, base.ng, wo);
    const float all = evaluate(wo, wi).average();
    if (!(all > 0)) return 1;
    const float base_weight = (1 - shares(wo).coat) * (sheen.present() ? sheen.passed(side.cos_o, dot(side.ns, wi)) : 1);
    const float glossy = base.evaluate(wo, wi).average() * (1 - base.diffuse_share(wo, wi)) * base_weight;
    const float coated = coat.evaluate_with_pdf(base.ng, wo, wi).f_cos.average() * shares(wo).coat;
    return std::clamp(1 - (glossy + coated) / all, 0.f, 1.f);
}

Evaluation LayeredBsdf::evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
    const Shares p = shares(wo);
    const Facing side(base.ns, base.ng, wo);
    const float cos_i = dot(side.ns, wi);
    Evaluation e = base.evaluate_with_pdf(wo, wi);
    e.pdf *= p.base_probability;
    if (sheen.present() && side.cos_o > 0) {
        e.f_cos *= sheen.passed(side.cos_o, cos_i);
        if (cos_i > 0 && side.reflects(wi)) {
            e.f_cos += sheen.evaluate(side.ns, wo, wi, side.cos_o, cos_i);
            e.pdf += p.sheen_probability / (2 * kPi);
        }
    }
    e.f_cos *= 1 - p.coat;
    if (p.coat > 0) {
        const Evaluation c = coat.evaluate_with_pdf(base.ng, wo, wi);
        e.f_cos += c.f_cos * p.coat;
        e.pdf += c.pdf * p.coat_probability;
    }
    return e;
}

std::optional<BsdfSample> LayeredBsdf::sample(Vec3f wo, float u_lobe, Vec2f u) const {
    const Shares p = shares(wo);
    if (u_lobe < p.coat_probability) return sample_coat(p, wo, u);
    u_lobe -= p.coat_probability;
    if (u_lobe >= p.sheen_probability) {
        if (!(p.base_probability > 0)) return std::nullopt;
        u_lobe = (u_lobe - p.sheen_probability) / p.base_probability;
        return sample_base(p, wo, std::min(u_lobe, kBelowOne), u);
    }
    const Facing side(base.ns, base.ng, wo);
    if (side.cos_o <= 0) return std::nullopt;
    const Vec2f circle = unit_circle(u.x);
    const float z = u.y, r = std::sqrt(std::max(0.f, 1 - z * z));
    BsdfSample s;
    s.wi = Frame::from_normal(side.ns).to_world({r * circle.x, r * circle.y, z});
    return side.reflects(s.wi) ? weighed(s, wo) : std::nullopt;
}

/// Sets weight and density of a non-delta direction, summed over all lobes.
std::optional<BsdfSample> LayeredBsdf::weighed(BsdfSample s, Vec3f wo) const {
    const Evaluation e = evaluate_with_pdf(wo, s.wi);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f_cos / e.pdf;
    s.pdf = e.pdf;
    return s;
}

std::optional<BsdfSample> LayeredBsdf::sample_coat(const Shares& p, Vec3f wo,
                                                   Vec2f u) const {
    const Facing side(coat.ns, base.ng, wo);
    const Vec3f h =
        coat.smooth() ? side.ns : sample_visible_normal(side.ns, wo, coat.alpha, u);
    BsdfSample s;
    s.wi = reflect(wo, h);
    // A facet may reflect below the coat's horizon, where the density is 0.
    if (!side.reflects(s.wi) || dot(side.ns, s.wi) <= 0) return std::nullopt;
    if (!coat.smooth()) return weighed(s, wo);
    s.specular = true;
    s.pdf = p.coat_probability;
    s.weight = p.coat / p.coat_probability;
    return s;
}

std::optional<BsdfSample> LayeredBsdf::sample_base(const Shares& p, Vec3f wo,
                                                   float u_lobe, Vec2f u) const {
    auto s = base.sample(wo, u_lobe, u);
    if (!s || !s->specular) return s ? weighed(*s, wo) : s;
    const float passed =
        sheen.present() ? sheen.passed(dot(base.ns, wo), dot(base.ns, s->wi)) : 1.f;
    s->weight *= passed * (1 - p.coat) / p.base_probability;
    s->pdf *= p.base_probability;
    return s;
}

}  // namespace dg
