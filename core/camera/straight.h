// straight.h -- undeviated rays through the camera's origin: the chief rays of ideal lenses. Camera
// frame; film points in mm, upright.
#pragma once
#include <optional>

#include "math/vec.h"

namespace dg {

/// Unit direction of a film point.
inline Vec3d straight_direction(Vec2d film_mm, double film_distance_mm) {
    return normalize(Vec3d{film_mm.x, film_mm.y, -film_distance_mm});
}

/// Film point of a point or a direction; empty behind the camera.
inline std::optional<Vec2d> straight_film_point(Vec3d p, double film_distance_mm) {
    if (!(p.z < 0)) return std::nullopt;
    return Vec2d{p.x, p.y} * (film_distance_mm / -p.z);
}

}  // namespace dg
