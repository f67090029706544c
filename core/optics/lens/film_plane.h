// film_plane.h -- position and orientation of the film behind a lens; it may be tilted and shifted.
#pragma once
#include "math/vec.h"

namespace dg {

/// Film plane in the lens frame, mm. x and y are orthogonal unit vectors; the normal points away
/// from the lens.
struct FilmPlane {
    Vec3d center{}, x{1, 0, 0}, y{0, 1, 0};

    Vec3d normal() const { return cross(x, y); }
    Vec3d at(Vec2d film) const { return center + film.x * x + film.y * y; }
};

/// Film plane in float for the kernels. The distance of the centre is in LensTables::film_gap.
struct FilmPlaneTables {
    bool across = true;   // perpendicular to the axis and centred on it
    float center_x = 0, center_y = 0;
    float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, normal[3] = {0, 0, 1};

    FilmPlaneTables() = default;
    explicit FilmPlaneTables(const FilmPlane& plane)
        : across(false), center_x(float(plane.center.x)), center_y(float(plane.center.y)) {
        const Vec3d n = plane.normal();
        for (int k = 0; k < 3; ++k)
            x[k] = float(plane.x[k]), y[k] = float(plane.y[k]), normal[k] = float(n[k]);
    }
};

}  // namespace dg
