#include "render/flare/live/light_layer.h"

#include <cmath>

namespace dg {
namespace {

constexpr int kMargin = 2;   // nodes outside the frame

/// Weights of the three nodes around a pixel center: a quadratic B-spline, over the area of a square of nodes.
struct Weights {
    int first;
    std::array<float, 3> of;
    Weights(int pixel, int level) {
        const float pitch = float(1 << level), place = (float(pixel) + 0.5f) / pitch;
        const float nearest = std::floor(place + 0.5f), n = place - nearest;   // in [-1/2, 1/2)
        of = {0.5f * (0.5f - n) * (0.5f - n), 0.75f - n * n, 0.5f * (0.5f + n) * (0.5f + n)};
        for (float& w : of) w /= pitch;
        first = int(nearest) + kMargin - 1;
    }
};

}  // namespace

LightLayer::LightLayer(int width, int height) : width_(width), height_(height) {
    for (int level = 0; level < kLevels; ++level) {
        Grid& g = grids_[level];
        g.columns = (width >> level) + 2 + 2 * kMargin, g.rows = (height >> level) + 2 + 2 * kMargin;
        g.per_px = 1 / float(1 << level), g.zero = kMargin - (level == 0 ? 0.5f : 0);
        g.nodes.resize(std::size_t(g.columns) * g.rows);
    }
}

void LightLayer::add(const LightLayer& other) {
    for (int level = 0; level < kLevels; ++level) {
        const std::vector<Node>& from = other.grids_[level].nodes;
        for (std::size_t i = 0; i < from.size(); ++i)
            for (int c = 0; c < 4; ++c) grids_[level].nodes[i].c[c] += from[i].c[c];
    }
}

void LightLayer::add_to(std::vector<Node>& pixels, const Grid& g, int level) const {
    std::vector<Node> down(g.columns);
    std::vector<Weights> across;
    for (int x = 0; x < width_; ++x) across.emplace_back(x, level);
    for (int y = 0; y < height_; ++y) {
        const Weights wy(y, level);
        const Node* const from = &g.nodes[std::size_t(wy.first) * g.columns];
        for (int x = 0; x < g.columns; ++x)
            for (int c = 0; c < 4; ++c)
                down[x].c[c] = wy.of[0] * from[x].c[c] + wy.of[1] * from[x + g.columns].c[c] +
                               wy.of[2] * from[x + 2 * g.columns].c[c];
        Node* const to = &pixels[std::size_t(y) * width_];
        for (int x = 0; x < width_; ++x) {
            const Weights& w = across[x];
            const Node* const at = &down[w.first];
            for (int c = 0; c < 4; ++c)
                to[x].c[c] += w.of[0] * at[0].c[c] + w.of[1] * at[1].c[c] + w.of[2] * at[2].c[c];
        }
    }
}

std::vector<float> LightLayer::pixels() const {
    std::vector<Node> sums(std::size_t(width_) * height_);
    const Grid& fine = grids_[0];   // nodes at pixel centers
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            sums[std::size_t(y) * width_ + x] = fine.nodes[std::size_t(y + kMargin) * fine.columns + x + kMargin];
    for (int level = 1; level < kLevels; ++level) add_to(sums, grids_[level], level);
    std::vector<float> rgb;
    rgb.reserve(3 * sums.size());
    for (const Node& n : sums) rgb.insert(rgb.end(), n.c, n.c + 3);
    return rgb;
}

}  // namespace dg
