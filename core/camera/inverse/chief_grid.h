// chief_grid.h -- chief rays (see chief.h) over the whole film, for exact lenses that are not the same on all
// sides of the camera's axis: tilted, decentred and anamorphic ones.
#pragma once
#include <optional>
#include <vector>

#include "camera/exact.h"

namespace dg {

class ChiefGrid {
  public:
    /// Throws Error if no light passes near the middle of the film.
    explicit ChiefGrid(const ExactLens& lens);

    struct Line {
        Vec3d foot, direction;  // the point nearest to the camera's origin, m; unit
        double start = 0;       // of the lens's own rays, m past the foot
    };
    /// Between nodes by cubics, past the film linear.
    Line at(Vec2d film_mm) const;
    /// Film point, like ChiefRays::film_point.
    std::optional<Vec2d> film_point(Vec3d p, double w) const;

    /// Whether light comes to a film point; unknown between nodes that it reaches and others.
    enum class Lit { no, unknown, yes };
    Lit lit(Vec2d film_mm) const;

  private:
    /// Directions as vectors of their angle from straight ahead, which stay smooth beyond 90 degrees.
    struct Node {
        Vec2d angle;
        Vec3d foot;
        double start = 0;
    };
    static std::optional<Node> mean_ray(const ExactLens& lens, Vec2d film_mm);
    void fill_dark();
    Node node(int column, int row) const;
    Node interpolated(Vec2d film_mm) const;
    Vec2d miss(Vec2d film_mm, Vec3d p, double w) const;

    Vec2d corner_{}, step_{};   // mm
    std::vector<Node> nodes_;   // rows from corner_ on
    std::vector<bool> lit_;
};

}  // namespace dg
