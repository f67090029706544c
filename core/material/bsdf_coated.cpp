// bsdf_coated.cpp -- evaluation and sampling of coat and base together.
#include "material/bsdf_coated.h"

#include "material/fresnel.h"

namespace dg {
namespace {

// Below the transmittance of any coat; makes 0 / 0 at grazing angles 0.
constexpr float kNothing = 1e-9f;

float bent_cosine(float cosine, float n) {
    return std::sqrt(std::max(0.f, 1 - (1 - cosine * cosine) / (n * n)));
}

/// Facets of a metal with the roughness that a rough coat adds.
Facets blurred(const Facets& metal, const Facets& coat, float n) {
    if (coat.smooth) return metal;
    const float spread = 0.5f * (1 - 1 / n) * (1 - 1 / n);
    const auto wider = [&](float below, float above) {
        return std::min(1.f, std::sqrt((metal.smooth ? 0 : below * below) + spread * above * above));
    };
    Facets f = metal;
    f.ggx.alpha_t = std::max(kSmoothAlpha, wider(metal.ggx.alpha_t, coat.ggx.alpha_t));
    f.ggx.alpha_b = std::max(kSmoothAlpha, wider(metal.ggx.alpha_b, coat.ggx.alpha_b));
    f.smooth = f.ggx.alpha_t <= kSmoothAlpha && f.ggx.alpha_b <= kSmoothAlpha;
    return f;
}

/// Share of diffuse light from the base that the inside of a smooth coat reflects back to it, including absorption on
/// both passes. Five-point Gauss quadrature below and above the critical cosine.
Spectrum returned(float n, Spectrum depth) {
    constexpr int kNodes = 5;
    constexpr float kX[kNodes] = {0.04691008f, 0.23076534f, 0.5f, 0.76923466f, 0.95308992f};
    constexpr float kWeight[kNodes] = {0.11846344f, 0.23931434f, 0.28444444f, 0.23931434f, 0.11846344f};
    const float critical = std::sqrt(std::max(0.f, 1 - 1 / (n * n)));
    Spectrum sum(0.f);
    for (const auto& [low, high] : {Vec2f{0, critical}, Vec2f{critical, 1}}) {
        for (int i = 0; i < kNodes; ++i) {
            const float c = low + (high - low) * kX[i];
            const float r = fresnel_dielectric(c, 1 / n);
            sum += exp(depth * (-2 / c)) * (2 * c * r * kWeight[i] * (high - low));
        }
    }
    return sum;
}

}  // namespace

CoatedBsdf::CoatedBsdf(Vec3f ns, Vec3f ng, const ClearCoat& coat, const CoatedBase& base)
    : ns(ns), ng(ng), coat_(coat), base_(base), absorbs_(!coat.depth.is_black()) {
    const float f0 = normal_reflectance(coat.ior);
    if (!coat.facets.smooth) rough_.emplace(coat.ior, coat.facets);
    passed_mean_ = 1 - (rough_ ? rough_->mean().reflected(f0) : mean_fresnel(coat.ior));
    if (rough_ && !coat.compensated) {
        passed_mean_ -= rough_->mean().missing_thin;
        lost_inside_ = rough_->mean().missing_dense;
    }
    if (base.metal) {
        base_.facets = blurred(base.facets, coat.facets, coat.ior);
        if (!base.facets.smooth && coat.ior > 1) catch_below();
    } else {
        diffuse_ = base.diffuse / ((Spectrum(1.f) - (coat.linear ? Spectrum(1.f) : base.diffuse) * to_and_fro()) *
                                   (coat.ior * coat.ior));
    }
}

void CoatedBsdf::catch_below() {
    const StretchedGgx& g = base_.facets.ggx;
    const float alpha = std::sqrt(g.alpha_t * g.alpha_b);
    caught_.emplace(coat_.ior, alpha, base_.facets.distribution);
    if (!(caught_->mean() > 1e-6f)) return caught_.reset();
    const float passed = mean_passed(alpha, base_.facets.distribution);   // G
    const Spectrum r = base_.reflectance.at(2 / 3.f), k = to_and_fro();
    const float k0 = 1 - passed_mean_ / (coat_.ior * coat_.ior);
    interreflection_ = r * r * (passed * (1 - k0)) * k /
            ((Spectrum(1.f) - r * passed * k) * ((k0 - lost_inside_) * caught_->mean()));
}

/// K, including absorption of the coat.
Spectrum CoatedBsdf::to_and_fro() const {
    const float n = coat_.ior;
    const float k = 1 - passed_mean_ / (n * n) - lost_inside_;
    if (!absorbs_ || k <= 0) return k;
    return returned(n, coat_.depth) * (k / returned(n, 0.f)[0]);
}

CoatedBsdf::Bent CoatedBsdf::bent(Vec3f w, float cos_w) const {
    Bent b{.outside = cos_w, .inside = bent_cosine(cos_w, coat_.ior)};
    const GlassLobes lobes = rough_ ? rough_->toward(w, cos_w) : GlassLobes{};
    b.reflected = rough_ ? lobes.reflected(normal_reflectance(coat_.ior)) : fresnel_dielectric(cos_w, coat_.ior);
    b.entering = 1 - b.reflected;
    if (!coat_.compensated) b.entering = std::max(0.f, b.entering - lobes.missing_thin);
    b.passed = b.entering;
    if (caught_) b.caught = b.entering * caught_->of_passed(cos_w);
    if (absorbs_) b.passed *= exp(coat_.depth * (-1 / b.inside));
    return b;
}

/// Probability of sampling the coat's lobe.
float CoatedBsdf::coat_probability(const Bent& o) const {
    const float above = o.reflected * coat_.tint.average();
    const float below = base_.metal ? below_mirrored(o).average()
                                    : (o.passed * diffuse_).average() * passed_mean_;
    return above + below > 0 ? above / (above + below) : 1;
}

/// Light reflected by a smooth metal base, including inter-reflections.
Spectrum CoatedBsdf::below_mirrored(const Bent& o) const {
    const Spectrum r = base_.reflectance.at(o.inside);
    const Spectrum way = absorbs_ ? exp(coat_.depth * (-2 / o.inside)) : Spectrum(1.f);
    return o.passed * o.passed * r / (Spectrum(1.f) - r * way * o.reflected + kNothing);
}

Evaluation CoatedBsdf::coat_lobe(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const {
    if (coat_.facets.smooth) return {};
    const Facet f = coat_.facets.reflecting(side.ns, wo, wi, side.cos_o, cos_i);
    return {coat_.tint * (fresnel_dielectric(f.cos_h, coat_.ior) * f.f_cos), f.pdf};
}

Evaluation CoatedBsdf::diffuse_lobe(const Bent& o, const Bent& i) const {
    return {diffuse_ * o.passed * i.passed * (i.outside / kPi), i.outside / kPi};
}

Evaluation CoatedBsdf::metal_lobe(const Facing& side, Vec3f wo, Vec3f wi, const Bent& o, const Bent& i) const {
    if (base_.facets.smooth) return {};
    const Facet f = base_.facets.reflecting(side.ns, into(side.ns, wo, o), into(side.ns, wi, i), o.inside, i.inside);
    const float solid_angle = i.outside / (i.inside * coat_.ior * coat_.ior);   // inside over outside
    const Spectrum r = base_.reflectance.at(f.cos_h);
    const Spectrum way = absorbs_ ? exp(coat_.depth * (-1 / o.inside - 1 / i.inside)) : Spectrum(1.f);
    const Spectrum more = Spectrum(1.f) - r * way * std::min(o.reflected, i.reflected) + kNothing;
    return {o.passed * i.passed * r / more * (f.f_cos * solid_angle), f.pdf * solid_angle};
}

/// Probability of sampling the diffuse lobe, for light that enters the coat over a metal.
float CoatedBsdf::interreflection_probability(const Bent& o) const {
    if (!caught_) return 0;
    const float interreflected = o.caught * interreflection_.average() * caught_->mean();
    const float mirrored = base_.reflectance.at(o.inside).average() * (o.passed.average() - o.caught);
    return interreflected > 0 ? interreflected / (interreflected + std::max(0.f, mirrored)) : 0;
}

Evaluation CoatedBsdf::interreflection_lobe(const Bent& o, const Bent& i) const {
    const Spectrum way = absorbs_ ? exp(coat_.depth * (-1 / o.inside - 1 / i.inside)) : Spectrum(1.f);
    return {interreflection_ * way * (o.caught * i.caught * i.outside / kPi), i.outside / kPi};
}

Evaluation CoatedBsdf::evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
    const Facing side(ns, ng, wo);
    const float cos_i = dot(side.ns, wi);
    if (is_specular() || side.cos_o <= 0 || cos_i <= 0 || !side.reflects(wi)) return {};
    const Bent o = bent(wo, side.cos_o), i = bent(wi, cos_i);
    const float p = coat_probability(o);
    Evaluation e = coat_lobe(side, wo, wi, cos_i);
    Evaluation below = base_.metal ? metal_lobe(side, wo, wi, o, i) : diffuse_lobe(o, i);
    if (caught_) {
        const Evaluation interreflected = interreflection_lobe(o, i);
        const float q = interreflection_probability(o);
        below = {below.f_cos + interreflected.f_cos, (1 - q) * below.pdf + q * interreflected.pdf};
    }
    e.f_cos += below.f_cos;
    e.pdf = p * e.pdf + (1 - p) * below.pdf;
    return e;
}

std::optional<BsdfSample> CoatedBsdf::mirrored(const Facing& side, Vec3f wo, Spectrum share, float probability) const {
    const Vec3f wi = reflect(wo, side.ns);
    if (!side.reflects(wi)) return std::nullopt;
    return BsdfSample{.wi = wi, .weight = share / probability, .pdf = probability, .specular = true};
}

/// Samples a direction outside by reflection at a facet of the metal; empty for total internal reflection in the coat.
std::optional<Vec3f> CoatedBsdf::sample_metal(const Facing& side, Vec3f wo, const Bent& o, Vec2f u) const {
    const Vec3f down = into(side.ns, wo, o);
    const Vec3f up = reflect(down, base_.facets.sample_visible(side.ns, down, u));
    const float cos_inside = dot(side.ns, up);
    const Vec3f across = (up - side.ns * cos_inside) * coat_.ior;
    const float sin2 = length_squared(across);
    if (cos_inside <= 0 || sin2 >= 1) return std::nullopt;
    return normalize(across + side.ns * std::sqrt(1 - sin2));
}

std::optional<BsdfSample> CoatedBsdf::sample(Vec3f wo, float u_lobe, Vec2f u) const {
    const Facing side(ns, ng, wo);
    if (side.cos_o <= 0) return std::nullopt;
    const Bent o = bent(wo, side.cos_o);
    const bool mirror_below = base_.metal && base_.facets.smooth;
    if (is_specular()) return mirrored(side, wo, coat_.tint * o.reflected + below_mirrored(o), 1);
    const float p = coat_probability(o);
    BsdfSample s;
    if (u_lobe < p) {
        if (coat_.facets.smooth) return mirrored(side, wo, coat_.tint * o.reflected, p);
        s.wi = reflect(wo, coat_.facets.sample_visible(side.ns, wo, u));
    } else {
        if (mirror_below) return mirrored(side, wo, below_mirrored(o), 1 - p);
        const bool diffuse = !base_.metal || (u_lobe - p) < interreflection_probability(o) * (1 - p);
        const auto wi = diffuse ? std::optional(sample_cosine(side.ns, u)) : sample_metal(side, wo, o, u);
        if (!wi) return std::nullopt;
        s.wi = *wi;
    }
    if (!side.reflects(s.wi)) return std::nullopt;
    const Evaluation e = evaluate_with_pdf(wo, s.wi);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f_cos / e.pdf;
    s.pdf = e.pdf;
    return s;
}

float CoatedBsdf::diffuse_share(Vec3f wo, Vec3f wi) const {
    if (base_.metal) return 0;
    const Facing side(ns, ng, wo);
    const float cos_i = dot(side.ns, wi), all = evaluate(wo, wi).average();
    if (!(all > 0)) return 1;
    return std::min(1.f, diffuse_lobe(bent(wo, side.cos_o), bent(wi, cos_i)).f_cos.average() / all);
}

}  // namespace dg
