#include "light/emission_ray.h"

#include "light/emitter.h"
#include "light/emitter_check.h"
#include "light/triangle_sampler.h"
#include "math/below_one.h"

namespace dg {
namespace {

// Share of a light's rays that are aimed at the spheres of the aim, if there are any.
constexpr float kAimed = 0.5f;
// Share of the choice of lights that is proportional to power; the rest is uniform.
constexpr double kByPower = 0.9;

/// Power of a lamp with a profile, lm; its bounds contain the profile's peak.
double power_of(const LightProfile& profile, const Light& light, const LightBounds& b) {
    const bool surface = std::holds_alternative<TriangleLight>(light);
    const Rgb share = surface ? profile.facing_mean() : profile.mean();
    const double all = surface ? (b.two_sided ? 2 : 1) * kPiD : 4 * kPiD;
    return profile.peak() > 0 ? all * b.intensity * max_component(share) / profile.peak() : 0;
}

/// Largest power over time, lm. Lights from infinity illuminate the disc of the scene's bounding sphere.
double power_of(const LightSet& lights, std::size_t light, float scene_radius) {
    const double disc = kPiD * double(scene_radius) * scene_radius;
    if (const float lux = lights.infinite_weight(light); lux > 0) return lux * disc;
    const LightBounds b = lights.bounds_of(light);
    if (const LightProfile* profile = lights.profile_of(light)) return power_of(*profile, lights.lights()[light], b);
    if (b.spread >= kPi) return 4 * kPiD * b.intensity;
    if (b.falloff > 0) return (b.two_sided ? 2 : 1) * kPiD * b.intensity;   // cosine emission
    return 2 * kPiD * (1 - std::cos(double(b.spread))) * b.intensity;
}

/// Directions uniform in a cone, or aimed at the spheres of the aim. The whole sphere has the spread 2.
struct ConeEmission {
    const EmissionAim& aim;
    Vec3f from, axis;
    float spread;   // 1 - cos

    float aimed() const { return aim.empty() ? 0 : kAimed; }
    Vec3f sample(Vec2f u) const {
        if (u.x < aimed()) return aim.direction(from, {u.x / aimed(), u.y});
        u.x = std::min((u.x - aimed()) / (1 - aimed()), kBelowOne);
        return normalize(Frame::from_normal(axis).to_world(warp_cone(u, spread)));
    }
    float pdf(Vec3f w) const {
        const bool within = spread >= 2 || dot(w, axis) >= 1 - spread;
        const float plain = within ? (1 - aimed()) * warp_cone_pdf(spread) : 0;
        return plain + (aim.empty() ? 0 : aimed() * aim.direction_pdf(from, w));
    }
};

/// Directions from a surface with cosine distribution, or aimed. pdf() is the density over the cosine, and 0 behind a
/// one-sided surface.
struct SurfaceEmission {
    const EmissionAim& aim;
    Vec3f from, normal;
    bool two_sided = false;

    float aimed() const { return aim.empty() ? 0 : kAimed; }
    Vec3f sample(Vec2f u) const {
        if (u.x < aimed()) return aim.direction(from, {u.x / aimed(), u.y});
        u.x = std::min((u.x - aimed()) / (1 - aimed()), kBelowOne);
        const bool behind = two_sided && u.y < 0.5f;
        if (two_sided) u.y = std::min(behind ? 2 * u.y : 2 * u.y - 1, kBelowOne);
        const Frame frame = Frame::from_normal(behind ? -normal : normal);
        return normalize(frame.to_world(warp_cosine_hemisphere(u)));
    }
    float pdf(Vec3f w) const {
        const float cosine = two_sided ? std::abs(dot(w, normal)) : dot(w, normal);
        if (!(cosine > 0)) return 0;
        const float plain = (1 - aimed()) / (two_sided ? 2 * kPi : kPi);
        return plain + (aim.empty() ? 0 : aimed() * aim.direction_pdf(from, w) / cosine);
    }
};

SurfaceEmission surface(const EmissionAim& aim, const TriangleSampler& t, Vec3f from) {
    return {aim, from, t.normal() * (0.5f / t.area), t.two_sided};
}
SurfaceEmission surface(const EmissionAim& aim, const SphereLight& s, Vec3f from) {
    return {aim, from, normalize(from - s.shape.center)};
}
/// 1 - cos of the profile's cone, slightly enlarged against rounding at its edge.
float spread_of(float angle) {
    return float(std::min(2.0, 1 - std::cos(std::min(kPiD, angle + 1e-3))));
}
ConeEmission cone(const EmissionAim& aim, const PointLight& light) {
    if (!light.lamp.used() || light.lamp.spread >= kPi) return {aim, light.position, {0, 0, 1}, 2};
    return {aim, light.position, normalize(light.lamp.axis()), spread_of(light.lamp.spread)};
}
ConeEmission cone(const EmissionAim& aim, const SpotLight& light) {
    return {aim, light.position, light.direction,
            one_minus_cos_from_sin2(std::pow(std::sin(std::min(light.outer_angle, kPi / 2)), 2.f))};
}

float sphere_area_pdf(const SphereLight& s) {
    return 1 / (4 * kPi * s.shape.radius * s.shape.radius);
}

/// Origins of rays from infinity: on the disc of all lit surfaces, or aimed.
struct DiscEmission {
    const EmissionReach& reach;
    Vec3f w;

    float aimed() const { return reach.aim.empty() ? 0 : kAimed; }
    /// Samples an origin in front of all occluders.
    Vec3f sample(Vec2f u) const {
        Vec3f p;
        if (u.x < aimed()) {
            p = reach.aim.disc_point(w, {u.x / aimed(), u.y});
        } else {
            u.x = std::min((u.x - aimed()) / (1 - aimed()), kBelowOne);
            const Vec2f d = warp_disk(u) * reach.lit.radius;
            p = reach.lit.center + Frame::from_normal(w).to_world({d.x, d.y, 0});
        }
        return p - w * (dot(p - reach.all.center, w) + 1.01f * reach.all.radius);
    }
    float pdf(Vec3f p) const {
        const Vec3f to = p - reach.lit.center, across = to - w * dot(to, w);
        const float r2 = reach.lit.radius * reach.lit.radius;
        const float plain = length_squared(across) <= r2 ? (1 - aimed()) / (kPi * r2) : 0;
        return plain + (reach.aim.empty() ? 0 : aimed() * reach.aim.disc_pdf(p, w));
    }
};

// Samples a ray of an emitter; the density excludes the choice of the light.

bool leave(const EmissionReach& reach, const TriangleLight& light, Vec2f u_point, Vec2f u,
           EmissionRay& ray) {
    const TriangleSampler t(light);
    if (!(t.area > 0)) return false;
    const Vec2f b = warp_triangle(u_point);
    ray.barycentric = b;
    ray.origin = t.a + t.to_b * b.x + t.to_c * b.y;
    const SurfaceEmission out = surface(reach.aim, t, ray.origin);
    ray.direction = out.sample(u);
    ray.value = light.mean_luminance;
    ray.pdf = out.pdf(ray.direction) / t.area;
    return true;
}

bool leave(const EmissionReach& reach, const SphereLight& light, Vec2f u_point, Vec2f u,
           EmissionRay& ray) {
    ray.origin = light.shape.center + warp_sphere(u_point) * light.shape.radius;
    const SurfaceEmission out = surface(reach.aim, light, ray.origin);
    ray.direction = out.sample(u);
    ray.value = light.luminance;
    ray.pdf = out.pdf(ray.direction) * sphere_area_pdf(light);
    return true;
}

bool leave(const EmissionReach& reach, const PointLight& light, Vec2f, Vec2f u, EmissionRay& ray) {
    const ConeEmission out = cone(reach.aim, light);
    ray.origin = light.position;
    ray.direction = out.sample(u);
    ray.value = light.intensity;
    ray.pdf = out.pdf(ray.direction);
    return true;
}

bool leave(const EmissionReach& reach, const SpotLight& light, Vec2f, Vec2f u, EmissionRay& ray) {
    const ConeEmission out = cone(reach.aim, light);
    ray.origin = light.position;
    ray.direction = out.sample(u);
    ray.value = light.intensity * spot_attenuation(dot(ray.direction, light.direction),
                                                   light.inner_angle, light.outer_angle);
    ray.pdf = out.pdf(ray.direction);
    return true;
}

bool leave(const EmissionReach& reach, const DirectionalLight& light, Vec2f u_point, Vec2f u,
           EmissionRay& ray) {
    const DiscEmission out{reach, -toward_disc(light, u)};
    ray.origin = out.sample(u_point);
    ray.direction = out.w;
    ray.value = disc_illuminance(light);
    ray.pdf = out.pdf(ray.origin);
    return true;
}

// Density of a ray of an emitter to `position`.

float leaving_pdf(const EmissionReach& reach, const TriangleLight& light, Vec3f position, Vec3f wi,
                  float distance) {
    const TriangleSampler t(light);
    if (!(t.area > 0)) return 0;
    return surface(reach.aim, t, position + wi * distance).pdf(-wi) / t.area;
}

float leaving_pdf(const EmissionReach& reach, const SphereLight& light, Vec3f position, Vec3f wi,
                  float distance) {
    return surface(reach.aim, light, position + wi * distance).pdf(-wi) * sphere_area_pdf(light);
}

float leaving_pdf(const EmissionReach& reach, const PointLight& light, Vec3f, Vec3f wi,
                  float distance) {
    return cone(reach.aim, light).pdf(-wi) / (distance * distance);
}

float leaving_pdf(const EmissionReach& reach, const SpotLight& light, Vec3f, Vec3f wi,
                  float distance) {
    return cone(reach.aim, light).pdf(-wi) / (distance * distance);
}

float leaving_pdf(const EmissionReach& reach, const DirectionalLight&, Vec3f position, Vec3f wi, float) {
    return DiscEmission{reach, -wi}.pdf(position);
}

}  // namespace

EmissionRays::EmissionRays(const LightSet& lights, EmissionReach reach)
    : lights_(&lights), reach_(std::move(reach)) {
    const std::size_t count = lights.lights().size();
    std::vector<double> power(count + 1, 0.0);
    for (std::size_t i = 0; i < count; ++i) power[i] = power_of(lights, i, reach_.lit.radius);
    if (lights.samples_environment()) {
        power.back() = 4 * kPiD * lights.environment()->mean_luminance() * kPiD *
                       double(reach_.lit.radius) * reach_.lit.radius;
    }
    double sum = 0;
    int shining = 0;
    for (double& p : power) {
        if (!std::isfinite(p)) p = 0;
        sum += p;
        shining += p > 0;
    }
    if (!(sum > 0)) return;
    for (double& p : power)
        if (p > 0) p = kByPower * p + (1 - kByPower) * sum / shining;
    choice_ = DiscreteDistribution(std::span<const double>(power));
}

float EmissionRays::chance(std::int32_t light) const {
    if (choice_.empty()) return 0;
    return choice_.pmf(light == LightSet::kEnvironment ? choice_.size() - 1 : light);
}

std::optional<EmissionRay> EmissionRays::sample_sky(Vec2f u_point, Vec2f u_direction,
                                                    float time) const {
    const Environment& sky = *lights_->environment();
    const Environment::Sample s = sky.sample(u_direction, time);
    if (!(s.pdf > 0)) return std::nullopt;
    const DiscEmission out{reach_, -s.direction};
    EmissionRay ray;
    ray.light = LightSet::kEnvironment;
    ray.origin = out.sample(u_point);
    ray.direction = -s.direction;
    ray.value = sky.luminance(s.direction, time);
    ray.pdf = s.pdf * out.pdf(ray.origin);
    return ray;
}

std::optional<EmissionRay> EmissionRays::sample(float u_light, Vec2f u_point, Vec2f u_direction,
                                                float time) const {
    if (empty()) return std::nullopt;
    const DiscreteSample chosen = choice_.sample(u_light);
    std::optional<EmissionRay> ray(std::in_place);
    if (chosen.index + 1 == choice_.size()) {
        ray = sample_sky(u_point, u_direction, time);
    } else {
        ray->light = chosen.index;
        const auto from = [&](const auto& l) { return leave(reach_, l, u_point, u_direction, *ray); };
        const Light& light = lights_->lights()[chosen.index];
        if (std::holds_alternative<TriangleLight>(light)) {
            const auto now = lights_->triangle_at(chosen.index, time);
            if (!now || !from(*now)) return std::nullopt;
        } else {
            const Light now = lights_->light_at(chosen.index, time);
            if (!std::visit(from, now)) return std::nullopt;
            ray->value = ray->value * lights_->shaped(now, ray->direction);
        }
    }
    if (!ray || !(ray->pdf > 0)) return std::nullopt;
    ray->pdf *= chosen.pmf;
    return ray;
}

float EmissionRays::pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance,
                        float time) const {
    const float chosen = chance(light);
    if (!(chosen > 0)) return 0;
    if (light == LightSet::kEnvironment) {
        return chosen * lights_->environment()->pdf(wi, time) *
               DiscEmission{reach_, -wi}.pdf(position);
    }
    const auto from = [&](const auto& l) {
        return leaving_pdf(reach_, l, position, wi, distance);
    };
    if (!std::holds_alternative<TriangleLight>(lights_->lights()[light]))
        return chosen * std::visit(from, lights_->light_at(light, time));
    const auto now = lights_->triangle_at(light, time);
    return now ? chosen * from(*now) : 0;
}

float range_attenuation(const Light& light, float distance) {
    if (const auto* point = std::get_if<PointLight>(&light))
        return range_window(distance, point->range);
    if (const auto* spot = std::get_if<SpotLight>(&light))
        return range_window(distance, spot->range);
    return 1;
}

}  // namespace dg
