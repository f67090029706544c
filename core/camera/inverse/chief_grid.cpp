#include "camera/inverse/chief_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/mean_ray.h"
#include "math/error.h"

namespace dg {
namespace {

constexpr int kNodes = 33;  // per side
constexpr int kSide = 24;   // lens samples per side
constexpr double kBeyond = 3;   // largest distance of a search, in half sizes of the film
constexpr double kMargin = 1.02;

Vec2d angle_of(Vec3d d) {
    const double across = hypot(d.x, d.y);
    const double scale = across > 0 ? atan2(across, -d.z) / across : 1;
    return {d.x * scale, d.y * scale};
}

Vec3d direction_of(Vec2d angle) {
    const double a = length(angle), scale = a > 1e-12 ? std::sin(a) / a : 1;
    return {angle.x * scale, angle.y * scale, -std::cos(a)};
}

/// Catmull-Rom weights of four neighbours, at t past the second.
std::array<double, 4> cubic(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {0.5 * (2 * t2 - t3 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (4 * t2 - 3 * t3 + t),
            0.5 * (t3 - t2)};
}

}  // namespace

/// Mean ray as in chief.cpp: means over planes across the mean direction.
std::optional<ChiefGrid::Node> ChiefGrid::mean_ray(const ExactLens& lens, Vec2d film_mm) {
    const std::vector<CameraSample> samples =
        lens_cells({float(film_mm.x), float(film_mm.y)}, kSide);
    std::vector<CameraRay> rays(samples.size());
    lens.generate(samples, rays);
    Vec3d axis = summed_direction(rays);
    if (!(length(axis) > 0)) return std::nullopt;
    axis = normalize(axis);
    const RayMeans mean = means_across(axis, rays);
    const Vec3d d = normalize(mean.slope), o = mean.crossing, foot = o - d * dot(o, d);
    return Node{angle_of(d), foot, mean.start - dot(foot, axis)};
}

ChiefGrid::ChiefGrid(const ExactLens& lens) : nodes_(kNodes * kNodes), lit_(nodes_.size()) {
    const ExactLensSettings& s = lens.settings();
    const bool whole = !(s.film_half_mm.x > 0 && s.film_half_mm.y > 0);
    const double reach = s.half_diagonal_mm / std::sqrt(2.0);
    const Vec2d half = whole ? Vec2d{reach, reach} : s.film_half_mm * kMargin;
    corner_ = (whole ? Vec2d{} : s.film_center_mm) - half;
    step_ = half * (2.0 / (kNodes - 1));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec2d film{corner_.x + double(i % kNodes) * step_.x, corner_.y + double(i / kNodes) * step_.y};
        const auto ray = mean_ray(lens, film);
        lit_[i] = ray.has_value();
        if (ray) nodes_[i] = *ray;
    }
    fill_dark();
}

ChiefGrid::Lit ChiefGrid::lit(Vec2d film_mm) const {
    const auto cell = [](double at) { return std::clamp(int(std::floor(at)), 0, kNodes - 2); };
    const int x = cell((film_mm.x - corner_.x) / step_.x), y = cell((film_mm.y - corner_.y) / step_.y);
    const int first = y * kNodes + x;
    const int found = lit_[first] + lit_[first + 1] + lit_[first + kNodes] + lit_[first + kNodes + 1];
    return found == 4 ? Lit::yes : found == 0 ? Lit::no : Lit::unknown;
}

/// Extrapolates chief rays linearly beyond the image circle, from two lit nodes in a row, ring by
/// ring.
void ChiefGrid::fill_dark() {
    std::vector<bool> lit = lit_;
    const auto inside = [](int x, int y) { return x >= 0 && y >= 0 && x < kNodes && y < kNodes; };
    const auto count = std::ranges::count(lit, true);
    if (count < 16) throw Error("chief rays: no light passes the lens near the middle of the film");
    for (bool changed = true; changed && !std::ranges::all_of(lit, [](bool b) { return b; });) {
        changed = false;
        std::vector<bool> next = lit;
        for (int y = 0; y < kNodes; ++y)
            for (int x = 0; x < kNodes; ++x) {
                if (lit[y * kNodes + x]) continue;
                Node sum{};
                int found = 0;
                for (const auto& [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                    const int ax = x + dx, ay = y + dy, bx = x + 2 * dx, by = y + 2 * dy;
                    if (!inside(bx, by) || !lit[ay * kNodes + ax] || !lit[by * kNodes + bx]) continue;
                    const Node &a = nodes_[ay * kNodes + ax], &b = nodes_[by * kNodes + bx];
                    sum.angle = sum.angle + a.angle * 2.0 - b.angle;
                    sum.foot += a.foot * 2.0 - b.foot, sum.start += 2 * a.start - b.start;
                    ++found;
                }
                if (!found) continue;
                nodes_[y * kNodes + x] = {sum.angle * (1.0 / found), sum.foot / double(found),
                                          sum.start / found};
                next[y * kNodes + x] = changed = true;
            }
        lit = next;
    }
}

/// Node; beyond the edge, extrapolated linearly from the last two.
ChiefGrid::Node ChiefGrid::node(int column, int row) const {
    const auto mixed = [](const Node& a, const Node& b, double t) {
        return Node{a.angle + (b.angle - a.angle) * t, a.foot + (b.foot - a.foot) * t,
                    a.start + (b.start - a.start) * t};
    };
    constexpr int last = kNodes - 1;
    if (column < 0) return mixed(node(0, row), node(1, row), column);
    if (column > last) return mixed(node(last, row), node(last - 1, row), last - column);
    if (row < 0) return mixed(node(column, 0), node(column, 1), row);
    if (row > last) return mixed(node(column, last), node(column, last - 1), last - row);
    return nodes_[row * kNodes + column];
}

ChiefGrid::Node ChiefGrid::interpolated(Vec2d film_mm) const {
    const double x = (film_mm.x - corner_.x) / step_.x, y = (film_mm.y - corner_.y) / step_.y;
    const int column = int(std::floor(x)), row = int(std::floor(y));
    const auto wx = cubic(x - column), wy = cubic(y - row);
    Node sum{};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const Node n = node(column + i - 1, row + j - 1);
            const double w = wx[i] * wy[j];
            sum.angle = sum.angle + n.angle * w;
            sum.foot += n.foot * w, sum.start += n.start * w;
        }
    return sum;
}

ChiefGrid::Line ChiefGrid::at(Vec2d film_mm) const {
    const Node n = interpolated(film_mm);
    const Vec3d d = direction_of(n.angle);
    return {n.foot - d * dot(n.foot, d), d, n.start};
}

/// Angle between the direction of the point as seen from the ray, and the ray's direction; 0 on the
/// ray.
Vec2d ChiefGrid::miss(Vec2d film_mm, Vec3d p, double w) const {
    const Line line = at(film_mm);
    return angle_of(normalize(p - line.foot * w)) - angle_of(line.direction);
}

std::optional<Vec2d> ChiefGrid::film_point(Vec3d p, double w) const {
    const Vec2d half = step_ * (0.5 * (kNodes - 1)), middle = corner_ + half;
    const double size = std::max(half.x, half.y), h = 1e-4 * size;
    Vec2d film = middle;
    for (int i = 0; i < 60; ++i) {   // Newton's method with finite differences and limited steps
        const Vec2d here = miss(film, p, w);
        const Vec2d x = (miss({film.x + h, film.y}, p, w) - here) * (1 / h);
        const Vec2d y = (miss({film.x, film.y + h}, p, w) - here) * (1 / h);
        const double det = x.x * y.y - x.y * y.x;
        Vec2d step{-(here.x * y.y - here.y * y.x) / det, -(x.x * here.y - x.y * here.x) / det};
        if (!std::isfinite(step.x) || !std::isfinite(step.y)) return std::nullopt;
        if (length(step) > size) step = step * (size / length(step));
        film = film + step;
        const Vec2d out = film - middle;
        if (std::abs(out.x) > kBeyond * half.x || std::abs(out.y) > kBeyond * half.y) return std::nullopt;
        if (length(step) > 1e-9 * size) continue;
        const Line line = at(film);
        if (!(dot(p - line.foot * w, line.direction) > w * line.start)) return std::nullopt;
        return film;
    }
    return std::nullopt;
}

}  // namespace dg
