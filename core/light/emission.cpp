#include "light/emission.h"

#include "light/emitter.h"

namespace dg {
namespace {

// Lower bound of the weight of emitters in view, as a fraction of the mean: the estimate ignores occlusion and the
// motion of objects.
constexpr double kLeastShare = 0.02;

/// The part of a sphere that points of a ball around the eye may see: normals n with n . axis > from, since
/// n . (x - centre) > radius for a point x of the ball. The density rises from 0 at the boundary like the cosine at the
/// emitter for those points, which bounds sample weights.
struct Side {
    Vec3f axis{0, 0, 1};
    float from = 1;   // 1: the eye is inside, so that no part is visible
    Side(const Sphere& sphere, const Viewpoint& view) {
        const Vec3f to = view.eye - sphere.center;
        const float d = length(to);
        if (d <= sphere.radius) return;
        axis = to * (1 / d);
        from = (sphere.radius - view.radius) / d;
    }
    Vec3f sample(Vec2f u) const {
        // A random number represents an interval of 2^-24; the density is 0 at the start of the first.
        const float z = from > -1 ? from + (1 - from) * std::sqrt(u.x + 0x1p-25f) : 1 - 2 * u.x;
        const float r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
        return Frame::from_normal(axis).to_world({r * std::cos(phi), r * std::sin(phi), z});
    }
    /// Density per unit area of the unit sphere.
    float pdf(Vec3f n) const {
        if (from >= 1) return 0;
        if (from <= -1) return 1 / (4 * kPi);
        return std::max(0.f, dot(n, axis) - from) / (kPi * (1 - from) * (1 - from));
    }
};

}  // namespace

// The orientation is tested only for static flat lights.
double illuminance_estimate(const LightBounds& b, bool moves, const ViewCone& view) {
    const Vec3f center = (b.min + b.max) * 0.5f;
    const float radius = 0.5f * length(b.max - b.min);
    if (!view.sees(center, radius)) return 0;
    const Vec3f to = view.from.eye - center;
    const double reach = radius + view.from.radius;
    const double d2 = std::max<double>(length_squared(to), reach * reach);
    if (!(d2 > 0)) return 0;
    double facing = 1;
    if (!moves && b.spread == 0) {   // a triangle
        const double toward = dot(to, b.axis), highest = toward + view.from.radius;
        if (!b.two_sided && highest <= 0) return 0;
        facing = std::clamp(std::abs(toward) / std::sqrt(d2), 0.01, 1.0);
    }
    return b.intensity * facing / d2;
}

std::optional<EmissionPoint> point_on(const TriangleSampler& triangle, Vec2f u) {
    if (!(triangle.area > 0)) return std::nullopt;
    const Vec2f b = warp_triangle(u);
    return EmissionPoint{.position = triangle.a + triangle.to_b * b.x + triangle.to_c * b.y,
                         .normal = triangle.normal() * (0.5f / triangle.area),
                         .pdf = 1 / triangle.area,
                         .barycentric = b};
}

std::optional<EmissionPoint> point_on(const Sphere& sphere, Vec2f u, const Viewpoint& view) {
    const Side side(sphere, view);
    if (side.from >= 1) return std::nullopt;
    const Vec3f n = side.sample(u);
    return EmissionPoint{.position = sphere.center + n * sphere.radius,
                         .normal = n,
                         .pdf = side.pdf(n) / (sphere.radius * sphere.radius)};
}

EmissionSampler::EmissionSampler(const LightSet& lights, std::span<const ViewCone> views, bool with_sky)
    : lights_(&lights), entry_of_(lights.lights().size(), -1) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < entry_of_.size(); ++i) {
        const Light& light = lights.lights()[i];
        if (!std::holds_alternative<TriangleLight>(light) && !std::holds_alternative<SphereLight>(light))
            continue;
        const LightBounds bounds = lights.bounds_of(i);
        const bool moves = lights.moves(i);
        double weight = 0;
        for (const ViewCone& view : views) weight += illuminance_estimate(bounds, moves, view);
        if (weight > 0 && std::isfinite(weight)) add(std::int32_t(i), weight / double(views.size()), weights);
    }
    const double sky = with_sky ? sky_weight(views) : 0;
    if (sky > 0) add(EmissionPoint::kSky, sky, weights);
    if (weights.empty()) return;
    double sum = 0;
    for (const double w : weights) sum += w;
    for (double& w : weights) w = std::max(w, kLeastShare * sum / double(weights.size()));
    choice_ = DiscreteDistribution(std::span<const double>(weights));
    if (sky > 0) sky_pmf_ = choice_.pmf(choice_.size() - 1);
}

void EmissionSampler::add(std::int32_t light, double weight, std::vector<double>& weights) {
    const auto* triangle = light < 0 ? nullptr : std::get_if<TriangleLight>(&lights_->lights()[light]);
    if (light >= 0) entry_of_[light] = std::int32_t(weights.size());
    weights.push_back(weight);
    chosen_.push_back(light);
    triangles_.push_back(triangle && !lights_->moves(light) ? TriangleSampler(*triangle)
                                                            : TriangleSampler());
}

/// Bright spots of the sky in the field of view, and their illuminance (lux).
double EmissionSampler::sky_weight(std::span<const ViewCone> views) {
    if (!lights_->has_environment()) return 0;
    sky_ = HotSky(*lights_->environment(), views);
    return sky_.illuminance();
}

std::optional<EmissionPoint> EmissionSampler::sample(float u_select, Vec2f u, float time,
                                                     const Viewpoint& view) const {
    if (empty()) return std::nullopt;
    const DiscreteSample choice = choice_.sample(u_select);
    const std::int32_t light = chosen_[choice.index];
    std::optional<EmissionPoint> point;
    if (light == EmissionPoint::kSky) {
        const Environment::Sample s = sky_.sample(u, time);
        point = EmissionPoint{.position = s.direction, .pdf = s.pdf};
    } else if (std::holds_alternative<TriangleLight>(lights_->lights()[light])) {
        point = sample_triangle(choice.index, u, time);
    } else {
        point = sample_sphere(choice.index, u, time, view);
    }
    if (!point || !(point->pdf > 0)) return std::nullopt;
    point->light = light;
    point->pdf *= choice.pmf;
    return point;
}

std::optional<EmissionPoint> EmissionSampler::sample_triangle(std::size_t entry, Vec2f u,
                                                              float time) const {
    TriangleSampler triangle = triangles_[entry];
    if (!(triangle.area > 0)) {
        const auto now = lights_->triangle_at(chosen_[entry], time);
        if (!now) return std::nullopt;
        triangle = TriangleSampler(*now);
    }
    return point_on(triangle, u);
}

std::optional<EmissionPoint> EmissionSampler::sample_sphere(std::size_t entry, Vec2f u, float time,
                                                            const Viewpoint& view) const {
    return point_on(lights_->sphere_light_at(chosen_[entry], time).shape, u, view);
}

float EmissionSampler::pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float time) const {
    if (empty()) return 0;
    const std::int64_t light = lights_->triangle_index(instance, primitive);
    const float chosen = pmf(light);
    if (!(chosen > 0)) return 0;
    float area = triangles_[entry_of_[light]].area;
    if (!(area > 0)) {
        const auto now = lights_->triangle_at(light, time);
        area = now ? triangle_area(*now) : 0;
    }
    return area > 0 ? chosen / area : 0;
}

float EmissionSampler::pdf_sphere(std::uint32_t sphere, Vec3f position, float time,
                                  const Viewpoint& view) const {
    if (empty()) return 0;
    const float chosen = pmf(lights_->sphere_index(sphere));
    if (!(chosen > 0)) return 0;
    const Sphere shape = lights_->sphere_at(sphere, time).shape;
    const Vec3f n = normalize(position - shape.center);
    return chosen * Side(shape, view).pdf(n) / (shape.radius * shape.radius);
}

float EmissionSampler::pdf_sky(Vec3f direction, float time) const {
    return sky_pmf_ > 0 ? sky_pmf_ * sky_.pdf(direction, time) : 0;
}

}  // namespace dg
