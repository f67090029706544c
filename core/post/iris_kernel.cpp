#include "post/iris_kernel.h"

#include <oneapi/tbb/parallel_for.h>

#include <limits>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kFine = 16;   // levels per px up to kFine px

/// Changes of coverage along the rows of a pixel grid.
class Coverage {
  public:
    Coverage(int left, int top, int width, int height)
        : left_(left), top_(top), width_(width), changes_(std::size_t(width) * height) {}

    /// Adds an edge of the outline: pixels to its right become covered, or uncovered for edges that
    /// run upward (y is down here). Within a pixel, the area to the right of a piece of edge is its
    /// height times the width to the right of its midpoint.
    void add(Vec2d a, Vec2d b, double weight) {
        if (a.y == b.y) return;
        if (a.y > b.y) return add(b, a, -weight);
        const double slope = (b.x - a.x) / (b.y - a.y);
        for (int row = int(std::floor(a.y)); row < b.y; ++row) {
            const double y0 = std::max(a.y, double(row)), y1 = std::min(b.y, row + 1.0);
            const double x0 = a.x + slope * (y0 - a.y), x1 = a.x + slope * (y1 - a.y);
            if (y1 > y0) add_in_row(row, std::min(x0, x1), std::max(x0, x1), weight * (y1 - y0));
        }
    }
    std::span<const double> changes() const { return changes_; }

  private:
    void add_in_row(int row, double x0, double x1, double height) {
        double* const changes = changes_.data() + std::size_t(row - top_) * width_ - left_;
        const double per_px = x1 > x0 ? height / (x1 - x0) : 0;
        for (int i = int(std::floor(x0)); i <= int(std::floor(x1)); ++i) {
            const double from = std::max(x0, double(i)), to = std::min(x1, i + 1.0);
            const double part = x1 > x0 ? per_px * (to - from) : height;
            const double past = 0.5 * (from + to) - i;   // fraction of the pixel to the left
            changes[i] += part * (1 - past);
            changes[i + 1] += part * past;
        }
    }

    int left_, top_, width_;
    std::vector<double> changes_;
};

/// Makes the changes of a row sum to exactly 0, so that no residue remains to the right.
void close_row(std::span<IrisKernel::Step> row) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < row.size(); ++i) sum += row[i].change;
    if (!row.empty()) row.back().change = -sum;
}

}  // namespace

IrisShape IrisShape::outline(std::span<const Vec2d> corners) {
    if (corners.size() < 3)
        throw input_error("iris outline", "corners", "3 or more", std::to_string(corners.size()));
    double area = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2d a = corners[i], b = corners[(i + 1) % corners.size()];
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    if (!(area > 0 && std::isfinite(area)))
        throw input_error("iris outline", "area", "> 0", std::to_string(area));
    const double scale = std::sqrt(kPiD / area);
    IrisShape shape;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        shape.edges.push_back({scale * corners[i], scale * corners[(i + 1) % corners.size()]});
        shape.outer_radius = std::max(shape.outer_radius, scale * length(corners[i]));
    }
    return shape;
}

IrisShape IrisShape::image(int width, int height, std::span<const float> values) {
    double sum = 0;
    for (const float v : values) {
        if (!(v >= 0 && v <= 1)) throw input_error("iris image", "value", "0 to 1", std::to_string(v));
        sum += v;
    }
    if (!(sum > 0)) throw Error("iris image: wanted an opening, got only black pixels");
    const double pixel = std::sqrt(kPiD / sum);
    IrisShape shape;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x <= width; ++x) {
            const double left = x > 0 ? values[std::size_t(y) * width + x - 1] : 0;
            const double right = x < width ? values[std::size_t(y) * width + x] : 0;
            if (left == right) continue;
            const Vec2d low{(x - 0.5 * width) * pixel, (0.5 * height - y - 1) * pixel};
            const Vec2d high{low.x, low.y + pixel};
            shape.edges.push_back({low, high, left - right});
            shape.outer_radius = std::max({shape.outer_radius, length(low), length(high)});
        }
    return shape;
}

IrisKernel iris_kernel(const IrisShape& shape, double radius) {
    const double extent = std::abs(radius) * shape.outer_radius + 0.5;
    if (!(extent <= std::numeric_limits<std::int16_t>::max() / 2))
        throw input_error("iris kernel", "radius", "up to 16000 px", std::to_string(radius));
    const int reach = int(std::ceil(extent)), side = 2 * reach + 3;
    Coverage coverage(-reach - 1, -reach - 1, side, side);
    const auto place = [&](Vec2d p) { return Vec2d{0.5 - p.x * radius, 0.5 + p.y * radius}; };
    const double area = kPiD * radius * radius;
    if (area > 1e-6)
        for (const auto& e : shape.edges) coverage.add(place(e.from), place(e.to), e.weight / area);
    else
        coverage.add({0, 0}, {0, 1}, 1), coverage.add({1, 0}, {1, 1}, -1);
    IrisKernel kernel{{}, {}, reach + 1, -reach - 1, reach + 1, -reach - 1};
    const std::span<const double> changes = coverage.changes();
    const double none = 1e-13 / std::max(1.0, area);   // rounding residue where coverage is constant
    for (int y = 0; y < side; ++y) {
        const std::size_t begin = kernel.steps.size();
        for (int x = 0; x < side; ++x) {
            const double change = changes[std::size_t(y) * side + x];
            if (std::abs(change) > none)
                kernel.steps.push_back({std::int16_t(x - reach - 1), std::int16_t(y - reach - 1), change});
        }
        const std::span row(kernel.steps.data() + begin, kernel.steps.size() - begin);
        close_row(row);
        if (row.empty() && kernel.row_begin.empty()) continue;
        if (kernel.row_begin.empty()) kernel.top = y - reach - 1;
        kernel.row_begin.push_back(std::int32_t(begin));
        if (row.empty()) continue;
        kernel.bottom = y - reach - 1;
        kernel.left = std::min(kernel.left, int(row.front().dx));
        kernel.right = std::max(kernel.right, int(row.back().dx) - 1);
    }
    kernel.row_begin.resize(kernel.bottom - kernel.top + 1);
    kernel.row_begin.push_back(std::int32_t(kernel.steps.size()));
    return kernel;
}

int IrisKernels::level(double radius) {
    const double r = std::abs(radius) / kFine;
    const int level = int(std::lround(kFine * kFine * (r < 1 ? r : 1 + std::log(r))));
    return radius < 0 ? -level : level;
}

double IrisKernels::rounded(double radius) {
    const double l = double(level(std::abs(radius))) / (kFine * kFine);
    return std::copysign(kFine * (l < 1 ? l : std::exp(l - 1)), radius);
}

IrisKernels::IrisKernels(const IrisShape& shape, std::span<const float> radii)
    : outer_radius_(float(shape.outer_radius)) {
    int highest = 0;
    for (const float r : radii) {
        if (!std::isfinite(r)) continue;
        lowest_ = std::max(lowest_, -level(r));
        highest = std::max(highest, level(r));
    }
    index_.assign(lowest_ + highest + 1, -1);
    std::vector<double> used;
    for (const float r : radii) {
        if (!std::isfinite(r)) continue;
        int& index = index_[level(r) + lowest_];
        if (index >= 0) continue;
        index = int(used.size());
        used.push_back(rounded(r));
    }
    kernels_.resize(used.size());
    oneapi::tbb::parallel_for(std::size_t(0), used.size(),
                              [&](std::size_t i) { kernels_[i] = iris_kernel(shape, used[i]); });
}

}  // namespace dg
