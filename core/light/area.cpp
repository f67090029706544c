// area.cpp -- area lights: spheres and triangles.
#include "light/emitter.h"
#include "light/emitter_check.h"
#include "light/triangle_sampler.h"

namespace dg {
namespace {

/// Cone of a sphere seen from `position`.
struct VisibleDisc {
    Vec3f to_center;
    float d2;             // squared distance of the center
    float one_minus_cos;  // of the cone; unused inside
    bool inside;
};

VisibleDisc visible_disc(const Sphere& sphere, Vec3f position) {
    VisibleDisc v;
    v.to_center = sphere.center - position;
    v.d2 = length_squared(v.to_center);
    const float r2 = sphere.radius * sphere.radius;
    v.inside = v.d2 <= r2;
    v.one_minus_cos = v.inside ? 2 : one_minus_cos_from_sin2(r2 / v.d2);
    return v;
}

/// Error bound of the hit distance on a ball, for half the length h of the ray inside the ball. A line that is
/// displaced by e enters at sqrt(h^2 +- 2 r e) instead of h, a difference of at most 2 r e / h and sqrt(2 r e).
float along_ray(const Sphere& ball, float half_chord) {
    const float e = lamp_error(largest_coordinate(ball.center) + ball.radius), square = 2 * ball.radius * e;
    return std::min(square / half_chord, std::sqrt(square));
}

}  // namespace

void narrow(LightBounds& bounds, const LampShape& lamp) {
    if (!lamp.used() || lamp.spread >= kPi) return;
    bounds.axis = normalize(lamp.axis());
    bounds.spread = lamp.spread;
    bounds.falloff = 0;
}

float triangle_area(const TriangleLight& light) {
    return TriangleSampler(light).area;
}

void check_emitter(const SphereLight& light, const std::string& where) {
    check_finite(where, "centre", light.shape.center);
    check_positive(where, "radius", light.shape.radius);
    check_finite(where, "radius", {light.shape.radius, 0, 0});
    check_color(where, "luminance", light.luminance);
}

void check_emitter(const TriangleLight& light, const std::string& where) {
    check_finite(where, "corner", light.a);
    check_finite(where, "corner", light.b);
    check_finite(where, "corner", light.c);
    check_color(where, "luminance", light.mean_luminance);
}

LightBounds emitter_bounds(const SphereLight& light) {
    const float r = light.shape.radius;
    LightBounds b;
    b.min = light.shape.center - Vec3f{r, r, r};
    b.max = light.shape.center + Vec3f{r, r, r};
    b.intensity = selection_weight(light.luminance) * kPi * r * r;
    narrow(b, light.lamp);
    return b;
}

LightBounds emitter_bounds(const TriangleLight& light) {
    const Vec3f n = TriangleSampler(light).normal();
    LightBounds b;
    b.min = {std::min({light.a.x, light.b.x, light.c.x}),
             std::min({light.a.y, light.b.y, light.c.y}),
             std::min({light.a.z, light.b.z, light.c.z})};
    b.max = {std::max({light.a.x, light.b.x, light.c.x}),
             std::max({light.a.y, light.b.y, light.c.y}),
             std::max({light.a.z, light.b.z, light.c.z})};
    if (!(length(n) > 0)) return b;  // no area: intensity 0
    b.axis = normalize(n);
    b.spread = 0;
    b.intensity = selection_weight(light.mean_luminance) * 0.5f * length(n);
    b.two_sided = light.two_sided;
    return b;
}

/// Uniform in the cone of the sphere; from inside, uniform over all directions.
std::optional<EmitterSample> sample_emitter(const SphereLight& light, Vec2f u,
                                            Vec3f position) {
    const VisibleDisc v = visible_disc(light.shape, position);
    const float r2 = light.shape.radius * light.shape.radius;
    Vec3f wi;
    if (v.inside) {
        wi = warp_sphere(u);
    } else {
        const Frame frame = Frame::from_normal(v.to_center * (1 / std::sqrt(v.d2)));
        wi = normalize(frame.to_world(warp_cone(u, v.one_minus_cos)));
    }
    // Nearest point of the line to the center; the squared distance is computed without cancellation.
    const float along = dot(v.to_center, wi);
    const float half_chord =
        std::sqrt(std::max(0.f, r2 - length_squared(v.to_center - wi * along)));
    const float distance = v.inside ? along + half_chord : along - half_chord;
    if (!(distance > 0)) return std::nullopt;
    return EmitterSample{wi, distance, light.luminance, emitter_pdf(light, position), false, {},
                         along_ray(light.shape, half_chord)};
}

float emitter_pdf(const SphereLight& light, Vec3f position) {
    const VisibleDisc v = visible_disc(light.shape, position);
    return v.inside ? warp_sphere_pdf() : warp_cone_pdf(v.one_minus_cos);
}

std::optional<EmitterSample> sample_emitter(const TriangleLight& light, Vec2f u,
                                            Vec3f position) {
    EmitterSample sample;
    if (!TriangleSampler(light).sample(u, position, sample)) return std::nullopt;
    return sample;
}

float emitter_pdf(const TriangleLight& light, float t, float cos_light) {
    return TriangleSampler(light).pdf(t, cos_light);
}

}  // namespace dg
