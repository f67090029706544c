#include "render/light_weight.h"

namespace dg {

LightWeight::LightWeight(const Scene& scene, const Camera& camera, const Sensor& sensor,
                         const FilmDensity& density, LightPlan plan, Technique technique,
                         std::shared_ptr<const LightGuide> guide)
    : scene_(scene), camera_(camera), plan_(plan), technique_(technique), guide_(std::move(guide)) {
    if (plan.off()) return;
    if (!guide_)
        guide_ = std::make_shared<const LightGuide>(scene, camera, sensor,
                                                    density.filter().radius(), plan);
    scale_ = density.integral_of_any_time();
}

Viewpoint LightWeight::viewpoint(float time) const {
    return {to_float(camera_.world_from_camera.at(time).origin), guide_->lens_radius};
}

std::optional<float> FirstRay::share(Vec3d at, double w, float emission_pdf, float cosine) const {
    if (!(emission_pdf > 0)) return std::nullopt;
    const Affine3d to_camera = inverse(weight_.pose(ray_.time));
    const Vec3d p = w > 0 ? to_camera.point(at) : to_camera.vector(at);
    const double light = weight_.of_light(emission_pdf, weight_.pupil().pdf(p, w, ray_), cosine);
    if (!(light > 0)) return std::nullopt;
    return weight_.camera_share(light, density());
}

std::optional<float> FirstRay::share_of_triangle(const SurfaceHit& hit) const {
    const float pdf = weight_.emission().pdf_triangle(hit.instance, hit.primitive, hit.time);
    return share(to_double(hit.position), 1, pdf, std::abs(dot(hit.ng, hit.wo)));
}

std::optional<float> FirstRay::share_of_sphere(std::uint32_t sphere, const SurfaceHit& hit) const {
    const float pdf = weight_.emission().pdf_sphere(sphere, hit.position, hit.time,
                                                    weight_.viewpoint(hit.time));
    const Vec3f center = weight_.scene().lights().sphere_at(sphere, hit.time).shape.center;
    return share(to_double(hit.position), 1, pdf,
                 std::abs(dot(normalize(hit.position - center), hit.wo)));
}

std::optional<float> FirstRay::share_of_sky(Vec3f direction) const {
    return share(to_double(direction), 0, weight_.emission().pdf_sky(direction, ray_.time), 1);
}

double FirstRay::lens_over_camera(Vec3f point) const {
    const Vec3d p = inverse(weight_.pose(ray_.time)).point(to_double(point));
    return weight_.pupil().pdf(p, 1, ray_) / density();
}

}  // namespace dg
