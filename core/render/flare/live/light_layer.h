// light_layer.h -- a layer of light as floats, on grids of nodes several pixels apart, for interactive previews.
// CoarseLight is the counterpart with integer sums, which do not depend on the order.
#pragma once
#include <array>
#include <vector>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace dg {

class LightLayer {
  public:
    static constexpr int kLevels = 5;   // nodes of the coarsest: 16 px apart

    LightLayer(int width, int height);

    /// Adds light x px^2 at a position, px, to the four nodes around it (a tent).
    void add(int level, Vec2f px, Rgb light) {
        Grid& g = grids_[level];
        const float x = px.x * g.per_px + g.zero, y = px.y * g.per_px + g.zero;
        if (!(x >= 0 && y >= 0 && x < float(g.columns - 1) && y < float(g.rows - 1))) return;
        const int column = int(x), row = int(y);
        const float fx = x - float(column), fy = y - float(row);
        Node* const node = &g.nodes[std::size_t(row) * g.columns + column];
        node[0].add(light, (1 - fx) * (1 - fy)), node[1].add(light, fx * (1 - fy));
        node[g.columns].add(light, (1 - fx) * fy), node[g.columns + 1].add(light, fx * fy);
    }
    void add(const LightLayer& other);
    /// R, G, B of pixels, row by row.
    std::vector<float> pixels() const;

  private:
    struct alignas(16) Node {
        float c[4] = {};
        void add(Rgb light, float w) { c[0] += w * light.x, c[1] += w * light.y, c[2] += w * light.z; }
    };
    struct Grid {
        int columns, rows;
        float per_px, zero;          // zero: position of the node at 0
        std::vector<Node> nodes;
    };
    void add_to(std::vector<Node>& pixels, const Grid& grid, int level) const;

    int width_, height_;
    std::array<Grid, kLevels> grids_;
};

}  // namespace dg
