#include "optics/polynomial/lens_map.h"

#include <algorithm>

#include "optics/lens_error.h"
#include "optics/polynomial/series_ray.h"

namespace dg {
namespace {

/// Where the ray meets the stop's surface, in the frame of that surface.
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
                "one that does not");
    }
    return {way.about, on_plane(ray, way.end_z)};
}

LensPath path_to_stop(const Tracer& tracer, LensPath path, int crossing) {
    std::vector<std::size_t> at;
    for (std::size_t k = 0; k < path.size(); ++k)
        if (path[k].surface == tracer.stop()) at.push_back(k);
    const int count = int(at.size()), which = crossing < 0 ? count + crossing : crossing;
    if (which < 0 || which >= count)
        throw input_error(
            tracer.prescription().name, "crossing of the iris",
            count ? "0 to " + std::to_string(count - 1) + ", or -1 for the last"
                  : "a path that meets the iris",
            std::to_string(crossing));
    path.resize(at[which] + 1);
    return path;
}

LensPath ghost_path(const Tracer& tracer, int one, int other, bool toward_film) {
    const Prescription& lens = tracer.prescription();
    const int count = int(lens.surfaces.size());
    const auto refuse = [&](const std::string& wanted, const std::string& got) {
        throw input_error(lens.name, "ghost", wanted, got);
    };
    for (const int i : {one, other}) {
        if (i < 0 || i >= count)
            refuse("surfaces of 0 .. " + std::to_string(count - 1), std::to_string(i));
        const LensIndices n = tracer.at(kDesignWavelength);
        if (n.index[i] == n.index[i + 1])
            refuse("surfaces that reflect", "surface " + std::to_string(i) +
                                                ", which has one medium on both sides");
    }
    if (one == other) refuse("two surfaces", "surface " + std::to_string(one) + " twice");
    return ghost_path(count, std::min(one, other), std::max(one, other), toward_film);
}

}  // namespace dg
