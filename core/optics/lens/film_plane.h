// film_plane.h -- where the film lies behind a lens: across the axis, or tilted and shifted against it.
#pragma once
#include "math/vec.h"

namespace dg {

/// Lens frame, mm. x and y are unit vectors at right angles; the normal points away from the lens.
struct FilmPlane {
    Vec3d center{}, x{1, 0, 0}, y{0, 1, 0};

    Vec3d normal() const { return cross(x, y); }
    Vec3d at(Vec2d film) const { return center + film.x * x + film.y * y; }
};

/// Tables for the kernels, besides the distance of its centre (LensTables::film_gap).
struct FilmTables {
    bool across = true;   // as a default FilmPlane on the axis
    float center_x = 0, center_y = 0;
    float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, normal[3] = {0, 0, 1};

    FilmTables() = default;
    explicit FilmTables(const FilmPlane& plane)
        : across(false), center_x(float(plane.center.x)), center_y(float(plane.center.y)) {
        const Vec3d n = plane.normal();
        for (int k = 0; k < 3; ++k)
            x[k] = float(plane.x[k]), y[k] = float(plane.y[k]), normal[k] = float(n[k]);
    }
};

}  // namespace dg
