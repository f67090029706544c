// straight.h -- rays that go straight on through the camera's origin, and meet the film behind it: the chief rays of
// ideal lenses. Camera frame; film points in mm, upright.
#pragma once
#include <optional>

#include "math/vec.h"

namespace dg {

/// The unit direction of a film point.
inline Vec3d straight_direction(Vec2d film_mm, double film_distance_mm) {
    return normalize(Vec3d{film_mm.x, film_mm.y, -film_distance_mm});
}

/// Its inverse: the film point of a point or of a direction; nothing behind the camera.
inline std::optional<Vec2d> straight_film_point(Vec3d p, double film_distance_mm) {
    if (!(p.z < 0)) return std::nullopt;
    return Vec2d{p.x, p.y} * (film_distance_mm / -p.z);
}

}  // namespace dg
