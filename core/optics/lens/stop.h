// stop.h -- the shape of the iris. One unit is the radius of the circle of equal area: so
// the f-number alone sets the exposure, whatever the number of blades.
#pragma once
#include <vector>

#include "math/vec.h"

namespace dg {

/// Shape seen along the view: x to the right, y up. A default Iris is round.
class Iris {
  public:
    enum class Kind { round, blades, image };

    Iris() = default;
    /// blades >= 3; at rotation 0 a corner points along +x, positive turns toward +y.
    /// curvature 0: straight edges; 1: the circle through the corners; negative: edges
    /// bent inward by as much.
    static Iris polygon(int blades, double rotation_deg, double curvature);
    /// Row 0 is the top; values are transmittances in [0, 1].
    static Iris image(int width, int height, std::vector<float> values);

    Kind kind() const { return kind_; }
    /// Exact: 1 inside, 0 outside, the nearest pixel's value for an image.
    double transmission(Vec2d p) const;
    /// Uniform on a region that covers the shape enlarged by the factor (in both
    /// directions).
    Vec2d sample(Vec2d u, double enlargement = 1) const;
    /// Area of that region, in units where the shape itself has area pi.
    double sampling_area(double enlargement = 1) const;
    /// Whether that region contains p.
    bool in_sampling_region(Vec2d p, double enlargement) const;
    double outer_radius() const;
    /// Radius of a circle all of which passes; 0 for an image.
    double inner_radius() const;

    // Tables, read by the SIMD version.
    struct Blades {
        std::vector<Vec2d> edge;  // unit vectors to the middles of the edges
        double apothem = 0;       // distance of the straight edges
        double center = 0;        // arc centres lie at edge[i] * center
        double arc_radius = 0;    // 0: straight
        int bend = 0;             // 1 outward, -1 inward
        std::vector<Vec2d>
            fan;  // corners of triangles of equal area around the origin, closed
    };
    struct Image {
        int width = 0, height = 0;
        double pixel = 0;  // side of a pixel
        std::vector<float> values;
        std::vector<Vec2d> support;  // lower corners of the pixels that are sampled
        std::vector<char> in_support;
    };
    const Blades& blades() const { return blades_; }
    const Image& picture() const { return image_; }

  private:
    Kind kind_ = Kind::round;
    Blades blades_;
    Image image_;
};

/// How much of the circle of radius q around the axis an iris lets through, 0 to 1: all
/// that an axially symmetric beam sees of its shape.
class RadialOpening {
  public:
    explicit RadialOpening(const Iris& iris);
    double at(double q) const;
    double outer() const { return outer_; }  // nothing passes beyond

  private:
    double outer_;
    std::vector<double> table_;  // at equal steps of q; empty: round
};

/// Square to unit disc, keeping neighbours together. Source: Shirley and Chiu 1997.
Vec2d concentric_disc(Vec2d u);

}  // namespace dg
