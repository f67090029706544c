#include "optics/expansion/elements.h"

#include <cmath>

#include "optics/expansion/series_ray.h"
#include "optics/lens/lens_error.h"

namespace dg {
namespace {

RayMap crossing(const SurfaceForm& form, const PathStep& step, double mu, int degree,
                const RayNumbers& about) {
    SurfaceForm alone = form;
    alone.place = SurfaceFrame{};
    SeriesRay ray = series_ray(ray_series(degree, about), 0, 1);
    if (!pass_series(alone, step, mu, "polynomial element", ray))
        throw lens_error("lens-no-light", -1, "polynomial element", "base ray",
                         "a ray that meets the surface and is not totally reflected",
                         "a ray that misses it or is totally reflected");
    return {about, on_plane(ray, 0)};
}

void check_index(double n) {
    if (!(n > 0) || !std::isfinite(n))
        throw input_error("polynomial element", "refractive index", "a positive number",
                          std::to_string(n));
}

}  // namespace

bool pass_series(const SurfaceForm& form, const PathStep& step, double mu,
                 const std::string& where, SeriesRay& ray) {
    const auto refuse = [&](const char* wanted, const std::string& got) {
        throw lens_error("lens-surface", step.surface, where, "Taylor expansion", wanted,
                         got);
    };
    if (!form.odd.empty()) {
        // r^odd has a series only away from the axis: check the base ray's intersection.
        RayOf<double> base{};
        for (int k = 0; k < 3; ++k)
            base.origin[k] = ray.origin[k].value(),
            base.direction[k] = ray.direction[k].value();
        if (!pass(form, step, mu, base)) return false;
        const Vec3d there = form.place.into(base.origin);
        if (there.x == 0 && there.y == 0)
            refuse("a form that is smooth where the base ray meets it",
                   "odd powers of r at the vertex");
    }
    try {
        return pass(form, step, mu, ray);
    } catch (const LensError&) {
        throw;
    } catch (const Error&) {
        refuse("a base ray that is not at grazing incidence or at the edge of the form",
               "a root of 0");
    }
    return false;
}

RayMap propagation(double distance, int degree, const RayNumbers& about) {
    if (!std::isfinite(distance))
        throw input_error("polynomial element", "distance", "a finite length in mm",
                          std::to_string(distance));
    return {about, on_plane(series_ray(ray_series(degree, about), 0, 1), distance)};
}

RayMap refraction(const SurfaceForm& form, double n1, double n2, int degree,
                  const RayNumbers& about) {
    check_index(n1), check_index(n2);
    return crossing(form, {-1, 1, false}, n1 / n2, degree, about);
}

// The z axis is reversed behind the mirror, so that the map ends on the plane z = 0.
RayMap reflection(const SurfaceForm& form, int degree, const RayNumbers& about) {
    return crossing(form, {-1, 1, true}, 1, degree, about);
}

RayMap placement(const Vec3d& decenter, const Vec3d& tilt, bool back, int degree,
                 const RayNumbers& about) {
    Surface s;
    s.decenter = decenter, s.tilt = tilt;
    const SurfaceFrame place = SurfaceForm(s, 0).place;
    const SeriesRay ray = series_ray(ray_series(degree, about), 0, 1);
    const SeriesRay there =
        back ? SeriesRay{place.out_of(ray.origin), place.turn_out(ray.direction)}
             : SeriesRay{place.into(ray.origin), place.turn_in(ray.direction)};
    if (!(there.direction.z.value() > 1e-12))  // rounding error of cos(90 degrees)
        throw input_error("polynomial element", "tilt",
                          "a frame in which the base ray goes forward",
                          "a frame in which it goes along the plane or back");
    return {about, on_plane(there, 0)};
}

}  // namespace dg
