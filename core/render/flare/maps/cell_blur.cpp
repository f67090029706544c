#include "render/flare/maps/cell_blur.h"

#include <algorithm>
#include <cmath>

#include "render/flare/maps/ghost_map.h"

namespace dg {
namespace {

constexpr int kLeft = kRimNode - 1, kRight = kRimNode + 1, kAbove = kRimNode - GhostMap::kSide,
              kBelow = kRimNode + GhostMap::kSide;

/// A 2 x 2 matrix by columns.
struct Mat2 {
    Vec2f a, b;
};
Vec2f operator*(const Mat2& m, Vec2f v) { return m.a * v.x + m.b * v.y; }
Mat2 operator*(const Mat2& m, const Mat2& n) { return {m * n.a, m * n.b}; }
Mat2 operator-(const Mat2& m, const Mat2& n) { return {m.a - n.a, m.b - n.b}; }
float det(const Mat2& m) { return m.a.x * m.b.y - m.a.y * m.b.x; }
Mat2 inverse(const Mat2& m) {
    const float d = 1 / det(m);
    return {Vec2f{m.b.y, -m.a.y} * d, Vec2f{-m.b.x, m.a.x} * d};
}
Vec2f transposed(const Mat2& m, Vec2f v) { return {dot(m.a, v), dot(m.b, v)}; }

/// The smaller singular value.
float least_stretch(const Mat2& m) {
    const float squares = dot(m.a, m.a) + dot(m.b, m.b), d = 2 * std::abs(det(m));
    return 0.5f * (std::sqrt(std::max(0.f, squares + d)) - std::sqrt(std::max(0.f, squares - d)));
}

struct Derivatives {
    const CellRays& rays;

    template <typename Value>
    Mat2 over_cell(const Value& value) const {
        return {value(rays.nodes[kRight]) - value(rays.nodes[kLeft]),
                value(rays.nodes[kBelow]) - value(rays.nodes[kAbove])};
    }
    template <typename Value>
    Mat2 over_source(const Value& value) const {
        const Vec2f middle = value(rays.nodes[kRimNode]);
        return {value(rays.rim[0]) - middle, value(rays.rim[1]) - middle};
    }
};

Vec2f clip_gradient(const Derivatives& d, const Mat2& landing) {   // over the film
    const Mat2 over_cell = d.over_cell([](const MapLanding& l) { return Vec2f{l.beyond, 0}; });
    return transposed(inverse(landing), {over_cell.a.x, over_cell.b.x});
}

/// Blur of the image of a mount's edge, px.
float mount_blur(const Derivatives& d, const Mat2& landing, const Mat2& moved) {
    const Mat2 over_source = d.over_source([](const MapLanding& l) { return Vec2f{l.beyond, 0}; });
    const Vec2f gradient = clip_gradient(d, landing);
    const Vec2f change = Vec2f{over_source.a.x, over_source.b.x} - transposed(moved, gradient);
    return length(change) / length(gradient);
}

/// Blur of the image of the iris at a crossing, px, in the worst direction.
float iris_blur(const Derivatives& d, int crossing, const Mat2& landing, const Mat2& moved) {
    const auto place = [&](const MapLanding& l) { return l.iris[crossing]; };
    return least_stretch(moved - landing * (inverse(d.over_cell(place)) * d.over_source(place)));
}

/// Estimated from the film areas of the squares between nodes.
float even_px(const CellRays& rays) {
    float least = 1e30f, most = 0, reach = 0;
    bool up = false, down = false;
    for (int y = 0; y + 1 < GhostMap::kSide; ++y)
        for (int x = 0; x + 1 < GhostMap::kSide; ++x) {
            const MapLanding* const at = rays.nodes + y * GhostMap::kSide + x;
            const Mat2 m{at[1].px - at[0].px, at[GhostMap::kSide].px - at[0].px};
            const float area = det(m);
            (area > 0 ? up : down) = true;
            least = std::min(least, std::abs(area)), most = std::max(most, std::abs(area));
            reach = std::max({reach, length(m.a), length(m.b)});
        }
    if (up && down) return 0;
    return (GhostMap::kSide - 2) * reach / std::max(0.05f, std::log(most / std::max(least, 1e-30f)));
}

bool holds_edge(const CellRays& rays) {
    bool in = false, out = false;
    for (int n = 0; n < GhostMap::kNodes; ++n) (rays.nodes[n].beyond < 0 ? in : out) = true;
    return in && out;
}

bool holds_iris_edge(const CellRays& rays, int crossing, const Iris& iris, double radius) {
    for (int n = 0; n < GhostMap::kNodes; ++n) {
        const Vec2f p = rays.nodes[n].iris[crossing];
        if (!(iris.transmission(Vec2d{p.x, p.y} * (1 / radius)) > 0)) return true;
    }
    return false;
}

}  // namespace

CellBlur cell_blur(const CellRays& rays, const Iris& iris, double iris_radius) {
    const auto sound = [](const MapLanding& l) { return l.sound; };
    if (!std::all_of(rays.nodes, rays.nodes + GhostMap::kNodes, sound) || !std::all_of(rays.rim, rays.rim + 2, sound))
        return {};
    const Derivatives d{rays};
    const auto px = [](const MapLanding& l) { return l.px; };
    const Mat2 landing = d.over_cell(px), moved = d.over_source(px);
    CellBlur blur;
    blur.light = blur.edge = least_stretch(moved);
    const auto add = [&](float edge) {   // NaN: the edge is unknown and counts as sharp
        blur.edge = edge >= 0 ? std::min(blur.edge, edge) : 0;
    };
    const auto finite = [](float v) { return std::isfinite(v) ? v : 0; };
    blur.even_px = finite(even_px(rays));
    blur.beyond_per_px = length(clip_gradient(d, landing));
    for (int k = 0; k < rays.crossings; ++k) {
        const auto place = [&](const MapLanding& l) { return l.iris[k]; };
        blur.px_per_mm[std::size_t(k)] = finite(least_stretch(landing * inverse(d.over_cell(place))));
    }
    if (holds_edge(rays)) add(mount_blur(d, landing, moved));
    for (int k = 0; k < rays.crossings; ++k)
        if (holds_iris_edge(rays, k, iris, iris_radius)) add(iris_blur(d, k, landing, moved));
    return blur;
}

}  // namespace dg
