#include "optics/aim/pupil_visible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>

#include "optics/aim/aim_simd.h"

namespace dg {
namespace {

constexpr int kWavelengths = int(std::size(kBoundWavelengths));

/// Tests which iris points are visible at any of the bound wavelengths.
class VisibilityTest {
  public:
    VisibilityTest(const LensTables& open, const AimTables& aim, Vec2d film, double orientation)
        : open_(open), aim_(aim), film_(film), orientation_(orientation) {}

    std::vector<bool> operator()(const std::vector<Vec2d>& points) {
        std::vector<bool> visible(points.size());
        const std::size_t rays = points.size() * kWavelengths;
        for (std::size_t begin = 0; begin < rays; begin += kLensBatch) {
            const auto ray = [&](int i) { return std::min(begin + i, rays - 1); };
            for (int i = 0; i < kLensBatch; ++i) {
                const Vec2d a = points[ray(i) % points.size()] * aim_.iris_scale;
                in_->x[i] = float(film_.x), in_->y[i] = float(film_.y);
                in_->u[i] = float(a.x), in_->v[i] = float(a.y);
                in_->nm[i] = float(kBoundWavelengths[ray(i) / points.size()]);
            }
            aim_slopes(open_, aim_, *in_, *rays_, jacobian_, kLensBatch);
            trace_to_scene(open_, *rays_, *out_, kLensBatch);
            for (int i = 0; i < kLensBatch; ++i) {
                jacobian_ok = jacobian_ok && jacobian_[i] * orientation_ > 0;
                if (out_->pass[i] > 0) visible[ray(i) % points.size()] = true;
            }
        }
        return visible;
    }
    bool jacobian_ok = true;

  private:
    const LensTables& open_;
    const AimTables& aim_;
    Vec2d film_;
    double orientation_;
    std::unique_ptr<LensSamples> in_ = std::make_unique<LensSamples>();
    std::unique_ptr<FilmRays> rays_ = std::make_unique<FilmRays>();
    std::unique_ptr<SceneRays> out_ = std::make_unique<SceneRays>();
    alignas(64) float jacobian_[kLensBatch];
};

/// Bounding box of the slopes within `range` that pass the mounts and reach the iris within
/// `radius` mm, found on an n x n grid and enlarged by one grid step.
SlopeBox passing_slopes(const LensTables& open, Vec2d film_mm, double radius, const SlopeBox& range,
                        int n) {
    SlopeBox box;
    const auto film = std::make_unique<FilmRays>();
    const auto out = std::make_unique<SceneRays>();
    const double dx = (range.x1 - range.x0) / n, dy = (range.y1 - range.y0) / n;
    const int grid = (n + 1) * (n + 1), rays = grid * kWavelengths;
    for (int begin = 0; begin < rays; begin += kLensBatch) {
        for (int i = 0; i < kLensBatch; ++i) {
            const int ray = std::min(begin + i, rays - 1), at = ray % grid;
            film->x[i] = float(film_mm.x), film->y[i] = float(film_mm.y);
            film->mx[i] = float(range.x0 + at % (n + 1) * dx);
            film->my[i] = float(range.y0 + at / (n + 1) * dy);
            film->nm[i] = float(kBoundWavelengths[ray / grid]);
        }
        trace_to_scene(open, *film, *out, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            const bool inside = hypot(out->iris_x[i], out->iris_y[i]) <= radius;
            if (out->pass[i] > 0 && inside)
                box.add({film->mx[i], film->mx[i], film->my[i], film->my[i]});
        }
    }
    box.grow(dx, dy);
    return box;
}

}  // namespace

Visible visible_iris(const LensTables& open, const AimTables& aim, Vec2d film_mm, double reach,
                     double orientation) {
    constexpr int kPoints = 49, kRows = 24, kFine = 6;
    VisibilityTest test(open, aim, film_mm, orientation);
    Visible v{Outline::dark(reach, kPoints)};
    Outline& o = v.outline;
    // Scan each column: the first and the last visible row bound the outline to within one step.
    std::vector<Vec2d> points;
    const auto row = [&](int i, int k) {
        const double half = std::sqrt(std::max(0.0, reach * reach - o.x(i) * o.x(i)));
        return half * (2.0 * k / kRows - 1);
    };
    for (int i = 0; i < kPoints; ++i)
        for (int k = 0; k <= kRows; ++k) points.push_back({o.x(i), row(i, k)});
    std::vector<bool> visible = test(points);
    std::vector<int> first(kPoints, -1), last(kPoints, -1);
    for (int i = 0; i < kPoints; ++i)
        for (int k = 0; k <= kRows; ++k)
            if (visible[i * (kRows + 1) + k]) last[i] = k, first[i] = first[i] < 0 ? k : first[i];
    points.clear();
    for (int i = 0; i < kPoints; ++i)
        for (int k = 1; k < kFine; ++k) {   // refine within the steps before the first and after the last visible
                                            // row
            const int f = std::max(first[i], 0), l = std::max(last[i], 0);
            const double t = double(k) / kFine;
            points.push_back({o.x(i), row(i, f) + t * (row(i, std::max(f - 1, 0)) - row(i, f))});
            points.push_back({o.x(i), row(i, l) + t * (row(i, std::min(l + 1, kRows)) - row(i, l))});
        }
    visible = test(points);
    for (int i = 0; i < kPoints; ++i) {
        if (last[i] < 0) continue;
        int below = 0, above = 0;
        for (int k = 1; k < kFine; ++k) {
            if (visible[2 * (i * (kFine - 1) + k - 1)]) below = k;
            if (visible[2 * (i * (kFine - 1) + k - 1) + 1]) above = k;
        }
        const double low = row(i, first[i]), high = row(i, last[i]);
        const double step = row(i, 1) - row(i, 0);
        o.low[i] = std::max(row(i, 0), low - step * (below + 1) / kFine);
        o.high[i] = std::min(row(i, kRows), high + step * (above + 1) / kFine);
        if (!(o.low[i] < o.high[i])) o.low[i] -= 1e-3 * reach, o.high[i] += 1e-3 * reach;
    }
    v.jacobian_ok = test.jacobian_ok;
    return v;
}

/// Finds the upper end of the visible part in each column of the iris: a coarse search upward from
/// the meridian, then a fine search in the step in which visibility ends.
Visible visible_half_iris(const LensTables& open, const AimTables& aim, double film_mm, double reach,
                          double orientation) {
    constexpr int kRows = 12, kFine = 8, kPoints = 97;
    VisibilityTest test(open, aim, {film_mm, 0}, orientation);
    Visible v{Outline::dark(reach, kPoints)};
    std::array<double, kPoints> half{}, low{}, step{};
    for (int i = 0; i < kPoints; ++i) {
        const double x = v.outline.x(i);
        step[i] = std::sqrt(std::max(0.0, reach * reach - x * x)) / kRows;
    }
    const auto search = [&](int rows) {
        std::vector<Vec2d> points;
        for (int i = 0; i < kPoints; ++i)
            for (int row = 0; row <= rows; ++row)
                points.push_back({v.outline.x(i), low[i] + row * step[i]});
        const std::vector<bool> visible = test(points);
        for (int i = 0; i < kPoints; ++i) {
            int last = rows;
            while (last >= 0 && !visible[i * (rows + 1) + last]) --last;
            // Take the first row that is not visible: conservative.
            if (last >= 0) half[i] = low[i] + std::min(last + 1, rows) * step[i];
            low[i] += std::max(last, 0) * step[i];
        }
    };
    search(kRows);
    for (int i = 0; i < kPoints; ++i) step[i] = (half[i] - low[i]) / kFine;
    const std::array<double, kPoints> coarse = half;
    search(kFine);
    for (int i = 0; i < kPoints; ++i)
        if (coarse[i] > 0) v.outline.low[i] = -half[i], v.outline.high[i] = half[i];
    v.jacobian_ok = test.jacobian_ok;
    return v;
}

void SlopeBox::add(const SlopeBox& b) {
    x0 = std::min(x0, b.x0), x1 = std::max(x1, b.x1);
    y0 = std::min(y0, b.y0), y1 = std::max(y1, b.y1);
}

void SlopeBox::grow(double x, double y) {
    if (!empty()) x0 -= x, x1 += x, y0 -= y, y1 += y;
}

SlopeBox passing_box(const LensTables& open, Vec2d film_mm, double radius,
                     const std::function<SlopeBox(double)>& range_at) {
    for (double reach = 1.5; reach < 100; reach *= 1.6) {
        const SlopeBox range = range_at(reach);
        SlopeBox box = passing_slopes(open, film_mm, radius, range, 48);
        if (box.empty()) box = passing_slopes(open, film_mm, radius, range, 160);
        const bool inside = !box.empty() && box.x0 > range.x0 && box.x1 < range.x1 &&
                            box.y0 > range.y0 && box.y1 < range.y1;
        if (!inside) continue;
        const SlopeBox fine = passing_slopes(open, film_mm, radius, box, 48);
        return fine.empty() ? box : fine;
    }
    return {};
}

}  // namespace dg
