// bsdf_translucent.h -- two-sided Lambertian reflection and Lambertian transmission.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/ggx.h"

namespace dg {

struct TranslucentBsdf {
    Vec3f ns, ng;
    Spectrum reflectance, transmittance;

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const {
        const Facing side(ns, ng, wo);
        const float cos_i = dot(side.ns, wi);
        const bool reflected = side.reflects(wi);
        if (side.cos_o <= 0 || (reflected ? cos_i <= 0 : cos_i >= 0)) return {};
        const float f = std::abs(cos_i) / kPi, p = reflect_probability();
        return reflected ? Evaluation{reflectance * f, p * f} : Evaluation{transmittance * f, (1 - p) * f};
    }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).f_cos; }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }

    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const {
        const Facing side(ns, ng, wo);
        const float p = reflect_probability();
        const bool transmitted = u_lobe >= p;
        const Vec3f up = sample_cosine(side.ns, u), wi = transmitted ? -up : up;
        const float cos_i = dot(side.ns, up), chosen = transmitted ? 1 - p : p;
        if (side.cos_o <= 0 || cos_i <= 0 || !(chosen > 0) || side.reflects(wi) == transmitted) return std::nullopt;
        return BsdfSample{.wi = wi,
                          .weight = (transmitted ? transmittance : reflectance) / chosen,
                          .pdf = chosen * cos_i / kPi,
                          .transmitted = transmitted};
    }
    static constexpr bool kOneLobe = false;
    bool is_specular() const { return false; }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    Spectrum straight_transmittance(Vec3f) const { return 0.f; }
    float reversed(Vec3f, Vec3f) const { return 1; }
    float diffuse_share(Vec3f, Vec3f) const { return 1; }

  private:
    float reflect_probability() const {
        const float r = reflectance.average(), t = transmittance.average();
        return r + t > 0 ? r / (r + t) : 1;
    }
};

}  // namespace dg
