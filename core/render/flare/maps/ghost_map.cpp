#include "render/flare/maps/ghost_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "optics/trace/lens_tables.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {

/// Weights of the Lagrange cubic through four equidistant nodes on [0, 1].
std::array<float, GhostMap::kSide> cubic_weights(float u) {
    const float t = 3 * u, a = t - 1, b = t - 2, c = t - 3;
    return {-a * b * c / 6, t * b * c / 2, -t * a * c / 2, t * a * b / 6};
}

float lambda_node(int k) {
    static const WavelengthScale scale = WavelengthScale::visible();
    return float(scale.wavelength(kLambdaStep * (k - 1)));
}

float GhostMap::glass(const Cell& cell, Vec2f u, float middle, float nm) const {
    const auto between = [](const float* nodes, int count, float place) {
        const int below = std::clamp(int(place), 0, count - 2);
        return nodes[below] + (place - float(below)) * (nodes[below + 1] - nodes[below]);
    };
    const float place = spectrum_place(nm);
    const auto corner = [&](int c) { return between(corners(cell) + c * kSpectrum, kSpectrum, place); };
    float off = 0;
    for (int c = 0; c < 4; ++c) off += corner_weights(u)[c] * corner(c);
    return middle * between(fine(cell), kFineSpectrum, place * kFine) + off;
}

const GhostMap::Cell* GhostMap::find(Vec2f at) const {
    const Vec2f u = region_.in(at);
    if (!(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1)) return nullptr;
    const auto after = std::ranges::upper_bound(codes_, code(u));
    if (after == codes_.begin()) return nullptr;
    const Cell& cell = cells_[std::size_t(after - codes_.begin()) - 1];
    return cell.holds(u) ? &cell : nullptr;
}

/// Interleaved bits of the finest cell (Morton 1966): each cell of a quadtree is a contiguous range.
std::uint32_t GhostMap::code(Vec2f u) {
    constexpr float kFinest = kFirstAcross << (kLevels - 1);
    const auto spread = [](float x) {
        std::uint32_t v = std::uint32_t(std::clamp(x * kFinest, 0.f, kFinest - 1));
        v = (v | v << 8) & 0x00ff00ffu, v = (v | v << 4) & 0x0f0f0f0fu;
        v = (v | v << 2) & 0x33333333u, v = (v | v << 1) & 0x55555555u;
        return v;
    };
    return spread(u.x) | spread(u.y) << 1;
}

}  // namespace dg
