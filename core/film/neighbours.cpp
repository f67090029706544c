#include "film/neighbours.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace dg {
namespace {

struct Neighbour {
    int dx, dy;
    float weight;
};

std::vector<Neighbour> of_next_colour(int reach) {
    std::vector<Neighbour> all;
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
            if ((dx + 2 * dy + 3 * reach) % 3 == 1)
                all.push_back({dx, dy, 1.f / float(dx * dx + dy * dy)});
    return all;
}

}  // namespace

std::vector<float> mean_of_next_colour(std::span<const float> plane, int width, int reach) {
    if (plane.empty()) return {};
    const int height = int(plane.size() / width);
    const double mean =
        std::accumulate(plane.begin(), plane.end(), 0.0) / std::max<std::size_t>(1, plane.size());
    const std::vector<Neighbour> neighbours = of_next_colour(reach);
    std::vector<float> out(plane.size()), weights(width);
    for (int y = 0; y < height; ++y) {
        float* const sums = out.data() + std::size_t(y) * width;
        std::ranges::fill(weights, 0.f);
        for (const auto [dx, dy, weight] : neighbours) {
            if (y + dy < 0 || y + dy >= height) continue;
            const float* const row = plane.data() + std::size_t(y + dy) * width;
            const int last = std::min(width, width - dx);
            for (int x = std::max(0, -dx); x < last; ++x) {
                sums[x] += weight * row[x + dx];
                weights[x] += weight;
            }
        }
        for (int x = 0; x < width; ++x)
            sums[x] = weights[x] > 0 ? sums[x] / weights[x] : float(mean);
    }
    return out;
}

}  // namespace dg
