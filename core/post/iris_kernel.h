// iris_kernel.h -- blur kernel of a defocused point: the iris with exact pixel coverage.
//
// A shape is stored as edges, a kernel as changes of coverage along rows. Splatting a point then
// costs the perimeter of its blur instead of the area; a single running sum per row completes all
// points together.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Opening of an iris with area pi as seen along the view: x right, y up. Light passes on the left
/// of an upward edge, by its weight; horizontal edges have no effect.
struct IrisShape {
    struct Edge {
        Vec2d from, to;
        double weight = 1;
    };
    std::vector<Edge> edges;
    double outer_radius = 0;

    /// Closed polygon around the opening, counterclockwise, of any area.
    static IrisShape outline(std::span<const Vec2d> corners);
    /// Transmittances 0 to 1, row 0 at the top.
    static IrisShape image(int width, int height, std::span<const float> values);
};

struct IrisKernel {
    struct Step {
        std::int16_t dx, dy;   // dy is down
        double change;         // of coverage, relative to the pixel on the left
    };
    std::vector<Step> steps;   // row-major; changes sum to 0 per row, running sums to 1 in total
    std::vector<std::int32_t> row_begin;   // index of the first step of rows top, ..., bottom, and the end
    int left = 0, right = 0, top = 0, bottom = 0;   // covered range; the last change is at right + 1

    int begin(int dy) const { return row_begin[dy - top]; }
};

/// Kernel of a shape with unit `radius` px: negative behind the focus, where the blur is upright;
/// positive in front of it, where it is inverted. Sums to 1.
IrisKernel iris_kernel(const IrisShape& shape, double radius);

/// Kernels for all radii of an image. Radii are rounded to 1/16 px up to 16 px, and to 0.4 %
/// beyond.
class IrisKernels {
  public:
    /// For the given signed radii, px; non-finite radii have no kernel.
    IrisKernels(const IrisShape& shape, std::span<const float> radii);
    const IrisKernel& at(float radius) const { return kernels_[index_[level(radius) + lowest_]]; }
    /// Extent of a pixel's blur, px.
    float reach(float radius) const { return outer_radius_ * std::abs(radius) * 1.004f + 1.5f; }

    /// Rounded radius of the kernel in use.
    static double rounded(double radius);

  private:
    static int level(double radius);
    int lowest_ = 0;
    float outer_radius_ = 1;
    std::vector<int> index_;
    std::vector<IrisKernel> kernels_;
};

}  // namespace dg
