// chief_grid.h -- chief rays (see chief.h) on a grid over the film, for exact lenses without axial
// symmetry: tilted, decentred and anamorphic.
#pragma once
#include <optional>
#include <vector>

#include "camera/exact.h"

namespace dg {

class ChiefGrid {
  public:
    /// Throws Error if no light passes near the centre of the film.
    explicit ChiefGrid(const ExactLens& lens);

    struct Line {
        Vec3d foot, direction;  // foot: point nearest to the camera's origin, m; direction: unit
        double start = 0;       // distance of the lens's ray origins past the foot, m
    };
    /// Cubic interpolation between nodes, linear extrapolation past the film.
    Line at(Vec2d film_mm) const;
    /// Film point, like ChiefRays::film_point.
    std::optional<Vec2d> film_point(Vec3d p, double w) const;

    /// Whether light reaches a film point; unknown between lit and dark nodes.
    enum class Lit { no, unknown, yes };
    Lit lit(Vec2d film_mm) const;

  private:
    /// Directions are stored as vectors of their angle from -z, which are smooth beyond 90 degrees.
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
    std::vector<Node> nodes_;   // row-major from corner_
    std::vector<bool> lit_;
};

}  // namespace dg
