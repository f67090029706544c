// series_ray.h -- rays of power series, between the four numbers on a plane and a point
// with a direction.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/trace/lens_path.h"

namespace dg {

using SeriesRay = RayOf<Series>;

/// On the plane z, on the way that `sign` says.
inline SeriesRay series_ray(const std::array<Series, 4>& r, double z, int sign) {
    const Series dz = sqrt(Series(1) - r[2] * r[2] - r[3] * r[3]);
    return {{r[0], r[1], Series(z)}, {r[2], r[3], sign < 0 ? -dz : dz}};
}

inline std::array<Series, 4> on_plane(const SeriesRay& ray, double z) {
    const Series t = (Series(z) - ray.origin.z) / ray.direction.z;
    return {ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y,
            ray.direction.x, ray.direction.y};
}

/// pass() with its place in the message where a form has no expansion at the base ray.
bool pass_series(const SurfaceForm& form, const PathStep& step, double mu,
                 const std::string& where, SeriesRay& ray);

}  // namespace dg
