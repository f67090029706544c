// series_ray.h -- conversion of rays of power series between four coordinates on a plane and point
// with direction.
#pragma once
#include "optics/expansion/ray_map.h"
#include "optics/trace/lens_path.h"

namespace dg {

using SeriesRay = RayOf<Series>;

/// Ray from the plane z; `sign` is its direction along z.
inline SeriesRay series_ray(const std::array<Series, 4>& r, double z, int sign) {
    const Series dz = sqrt(Series(1) - r[2] * r[2] - r[3] * r[3]);
    return {{r[0], r[1], Series(z)}, {r[2], r[3], sign < 0 ? -dz : dz}};
}

inline std::array<Series, 4> on_plane(const SeriesRay& ray, double z) {
    const Series t = (Series(z) - ray.origin.z) / ray.direction.z;
    return {ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y,
            ray.direction.x, ray.direction.y};
}

/// pass() on series; `where` names the surface in the error for forms without an expansion at the
/// base ray.
bool pass_series(const SurfaceForm& form, const PathStep& step, double mu,
                 const std::string& where, SeriesRay& ray);

}  // namespace dg
