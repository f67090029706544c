#include "transport/sharing/first_ray.h"

#include <cmath>

namespace dg {

std::optional<float> FirstRay::weight(Vec3d p, double w, float emission_pdf, float cosine) const {
    if (!(emission_pdf > 0)) return std::nullopt;
    const double light = sharing_.direct_density(emission_pdf, lens_pdf(p, w), cosine);
    if (!(light > 0)) return std::nullopt;
    return sharing_.camera_weight(light, camera_density());
}

std::optional<float> FirstRay::weight_of_triangle(const SurfaceHit& hit) const {
    const float pdf = sharing_.emission().pdf_triangle(hit.instance, hit.primitive, hit.time);
    return weight(to_double(hit.position), 1, pdf, std::abs(dot(hit.ng, hit.wo)));
}

std::optional<float> FirstRay::weight_of_sphere(const LightSet& lights, std::uint32_t sphere,
                                               const SurfaceHit& hit) const {
    const float pdf =
        sharing_.emission().pdf_sphere(sphere, hit.position, hit.time, viewpoint(hit.time));
    const Vec3f center = lights.sphere_at(sphere, hit.time).shape.center;
    return weight(to_double(hit.position), 1, pdf,
                 std::abs(dot(normalize(hit.position - center), hit.wo)));
}

std::optional<float> FirstRay::weight_of_sky(Vec3f direction) const {
    return weight(to_double(direction), 0, sharing_.emission().pdf_sky(direction, time_), 1);
}

}  // namespace dg
