// chief_map.h -- first-order map from iris points to film slopes about the chief rays of a grid of
// film points, for lenses without symmetry. Used as a starting point for searches only.
#pragma once
#include <vector>

#include "optics/lens/film_plane.h"
#include "optics/trace/trace.h"

namespace dg {

/// Used part of the film in film coordinates, mm.
struct FilmRectangle {
    Vec2d center{}, half{};

    Vec2d at(Vec2d unit) const { return {center.x + half.x * unit.x, center.y + half.y * unit.y}; }
};

class ChiefMap {
  public:
    /// Ignores clear apertures. Throws Error if no ray leads from the film's centre to the iris.
    ChiefMap(const Tracer& tracer, const FilmPlane& plane, const FilmRectangle& film);

    /// Slope at a film point (unit coordinates of the rectangle) toward an iris point in mm.
    Vec2d slope(Vec2d film, Vec2d iris) const;

  private:
    struct Local {
        Vec2d chief{}, film_x{}, film_y{}, iris_x{}, iris_y{};  // m, and its derivatives by unit film coordinates
                                                                // and by mm on the iris
        bool ok = false;

        Vec2d at(Vec2d film, Vec2d iris) const {
            return chief + film.x * film_x + film.y * film_y + iris.x * iris_x + iris.y * iris_y;
        }
    };

    std::optional<Vec2d> iris(Vec2d film, Vec2d m) const;
    Local solve(Vec2d film, Vec2d start) const;
    static Vec2d node(int i);

    const Tracer& tracer_;
    FilmPlane plane_;
    FilmRectangle film_;
    LensIndices index_;
    std::vector<Local> nodes_;
};

}  // namespace dg
