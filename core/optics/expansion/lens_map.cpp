#include "optics/expansion/lens_map.h"

#include "optics/expansion/series_ray.h"
#include "optics/lens/lens_error.h"

namespace dg {
namespace {

/// Intersection of the ray with the surface of the stop, in its frame.
std::array<Series, 4> at_stop(const SurfaceForm& form, const PathStep& step,
                              const std::string& where, const SeriesRay& ray) {
    SeriesRay there = ray;
    if (!pass_series(form, step, 1, where, there))
        throw lens_error("lens-no-light", step.surface, where, "Taylor expansion",
                         "a base ray that meets the iris", "a miss");
    const Vec3<Series> p = form.place.into(there.origin);
    const Vec3<Series> d = form.place.turn_in(ray.direction);
    return {p.x, p.y, d.x, d.y};
}

}  // namespace

RayMap lens_map(const Tracer& tracer, const LensIndices& n, const LensWay& way,
                int degree) {
    const int sign = way.path.empty() ? 1 : way.path.front().sign;
    SeriesRay ray = series_ray(ray_series(degree, way.about), way.start_z, sign);
    for (std::size_t k = 0; k < way.path.size(); ++k) {
        const PathStep& step = way.path[k];
        const SurfaceForm& form = tracer.form(step.surface);
        const std::string where = surface_name(tracer.prescription(), step.surface);
        if (way.to_iris && k + 1 == way.path.size())
            return {way.about, at_stop(form, step, where, ray)};
        const double mu = n.index[step.before()] / n.index[step.behind()];
        if (!pass_series(form, step, mu, where, ray))
            throw lens_error(
                "lens-no-light", step.surface, where, "Taylor expansion",
                "a base ray that meets the surface and is not totally reflected",
                "a ray that misses it or is totally reflected");
    }
    return {way.about, on_plane(ray, way.end_z)};
}

}  // namespace dg
