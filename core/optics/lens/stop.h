// stop.h -- shape of the iris, in units of the radius of the circle of equal area: the f-number
// alone sets the exposure, for any number of blades.
#pragma once
#include <vector>

#include "math/vec.h"

namespace dg {

/// Iris shape, x to the right and y up as seen along the view. A default Iris is round.
class Iris {
  public:
    enum class Kind { round, blades, image };

    Iris() = default;
    /// Regular polygon of blades >= 3. At rotation 0 a corner points along +x; positive rotations
    /// turn toward +y. curvature 0: straight edges; 1: the circle through the corners; negative:
    /// edges bent inward.
    static Iris polygon(int blades, double rotation_deg, double curvature);
    /// Transmittances in [0, 1]; row 0 is the top.
    static Iris image(int width, int height, std::vector<float> values);

    Kind kind() const { return kind_; }
    /// Transmittance at p: exactly 1 inside and 0 outside; the nearest pixel's value for an image.
    double transmission(Vec2d p) const;
    /// Samples uniformly a region that covers the shape enlarged by the factor in both directions.
    Vec2d sample(Vec2d u, double enlargement = 1) const;
    /// Area of the sampling region, in units in which the shape has area pi.
    double sampling_area(double enlargement = 1) const;
    /// Whether the sampling region contains p.
    bool in_sampling_region(Vec2d p, double enlargement) const;
    double outer_radius() const;
    /// Radius of the largest open circle around the axis; 0 for an image.
    double inner_radius() const;

    // Tables for the SIMD version.
    struct Blades {
        std::vector<Vec2d> edge;  // unit vectors to the middles of the edges
        double apothem = 0;       // distance of straight edges from the centre
        double center = 0;        // arc centres are edge[i] * center
        double arc_radius = 0;    // 0: straight edges
        int bend = 0;             // edges: 1 outward, -1 inward, 0 straight
        std::vector<Vec2d>
            fan;  // corners of triangles of equal area around the origin, closed
    };
    struct Image {
        int width = 0, height = 0;
        double pixel = 0;  // side of a pixel
        std::vector<float> values;
        std::vector<Vec2d> support;  // lower corners of the sampled pixels
        std::vector<char> in_support;
    };
    const Blades& blades() const { return blades_; }
    const Image& picture() const { return image_; }

  private:
    Kind kind_ = Kind::round;
    Blades blades_;
    Image image_;
};

/// Azimuthal mean of the iris transmittance at radius q from the axis, 0 to 1. Sufficient for
/// axially symmetric beams.
class RadialOpening {
  public:
    explicit RadialOpening(const Iris& iris);
    double at(double q) const;
    double outer() const { return outer_; }  // transmittance is 0 beyond

  private:
    double outer_;
    std::vector<double> table_;  // at equal steps of q; empty: round iris
};

/// Area-preserving map from the unit square to the unit disc. Source: Shirley and Chiu 1997.
Vec2d concentric_disc(Vec2d u);

}  // namespace dg
