// iris_kernel.h -- the blur of a point out of focus: the shape of the iris, as exact areas on pixels.
//
// A shape is kept as its edges, and a kernel as the change of coverage from pixel to pixel along rows. So
// a point is spread at the cost of the rim of its blur and not of its area; one running sum per row
// completes all of them together.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// The opening of an iris of area pi, seen along the view: x to the right, y up. Light passes to the left
/// of an edge that runs up, as much as its weight; edges along x have nothing to say.
struct IrisShape {
    struct Edge {
        Vec2d from, to;
        double weight = 1;
    };
    std::vector<Edge> edges;
    double outer_radius = 0;

    /// A closed line around the opening, counterclockwise, of any area.
    static IrisShape outline(std::span<const Vec2d> corners);
    /// Transmittances 0 to 1, row 0 at the top.
    static IrisShape image(int width, int height, std::span<const float> values);
};

struct IrisKernel {
    struct Step {
        std::int16_t dx, dy;   // down
        double change;         // of coverage, against the pixel to the left
    };
    std::vector<Step> steps;   // row by row; all sum to 0 along a row, and running sums to 1 in all
    std::vector<std::int32_t> row_begin;   // into steps: rows top, ..., bottom, and their end
    int left = 0, right = 0, top = 0, bottom = 0;   // of what is covered; the last change is at right + 1

    int begin(int dy) const { return row_begin[dy - top]; }
};

/// Kernel of a shape whose unit is `radius` px: negative behind the focus, where the blur has the shape's
/// way up; positive before it, where it stands upside down. Its sum is 1.
IrisKernel iris_kernel(const IrisShape& shape, double radius);

/// Kernels by radius, made once for all that occur. Radii are rounded to 1/16 px up to 16 px, and to 0.4 %
/// beyond.
class IrisKernels {
  public:
    /// For these signed radii, px; those that are not finite have no kernel.
    IrisKernels(const IrisShape& shape, std::span<const float> radii);
    const IrisKernel& at(float radius) const { return kernels_[index_[level(radius) + lowest_]]; }
    /// How far the light of a pixel goes, px.
    float reach(float radius) const { return outer_radius_ * std::abs(radius) * 1.004f + 1.5f; }

    /// The radius that stands for this one.
    static double rounded(double radius);

  private:
    static int level(double radius);
    int lowest_ = 0;
    float outer_radius_ = 1;
    std::vector<int> index_;
    std::vector<IrisKernel> kernels_;
};

}  // namespace dg
