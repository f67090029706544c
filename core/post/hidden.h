// hidden.h -- reconstruction of surfaces hidden behind edges: the farther surface is mirrored at
// the edge.
//
// Light passes blurred edges from places that the image does not show. They are estimated from four
// directions, along rows and columns: the nearest pixels beyond a decrease in `nearness`, mirrored
// at the step and weighted by the inverse square of their distance.
#pragma once
#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "post/spread.h"

namespace dg {

struct EdgeRule {
    std::span<const float> nearness;   // per pixel, larger is nearer; NaN: excluded
    float step;                        // difference from which a surface counts as behind another
    float deepest;                     // largest search distance behind an edge, px
};

/// Row or column of pixels.
struct PixelLine {
    std::size_t begin, stride;
    int count;
    std::size_t at(int i) const { return begin + std::size_t(i) * stride; }
};

/// Finds the pixels on the far side of steps in direction `way` (1 or -1): each is farther away
/// than its predecessor in that direction.
inline void find_far_edges(const EdgeRule& rule, const PixelLine& line, int way, std::vector<int>& edges) {
    edges.clear();
    for (int i = 1; i < line.count; ++i) {
        const int far = way > 0 ? i : i - 1, near = way > 0 ? i - 1 : i;
        if (rule.nearness[line.at(near)] - rule.nearness[line.at(far)] > rule.step) edges.push_back(far);
    }
}

/// Pixel i mirrored at the edge if it still shows the farther surface; otherwise the edge pixel.
inline int mirrored(const EdgeRule& rule, const PixelLine& line, int i, int edge, int way) {
    const int mirror = 2 * edge - i - way;
    if (mirror < 0 || mirror >= line.count) return edge;
    return rule.nearness[line.at(mirror)] <= rule.nearness[line.at(edge)] + rule.step ? mirror : edge;
}

/// Calls add(hidden pixel, source pixel, edge pixel, weight) along a line. `depth(near, far)`:
/// distance in px behind the edge of a near pixel up to which the far pixel's surface may become
/// visible.
template <typename Depth, typename Add>
void look_along(const EdgeRule& rule, const PixelLine& line, int way, std::vector<int>& edges,
                const Depth& depth, const Add& add) {
    find_far_edges(rule, line, way, edges);
    const int count = int(edges.size());
    int next = way > 0 ? 0 : -1;   // index of the first edge beyond i for way 1, of the last edge before i for way
                                   // -1
    for (int i = 0; i < line.count; ++i) {
        if (way > 0)
            while (next < count && edges[next] <= i) ++next;
        else
            while (next + 1 < count && edges[next + 1] < i) ++next;
        const std::size_t here = line.at(i);
        for (int e = next; e >= 0 && e < count; e += way) {
            const std::size_t there = line.at(edges[e]);
            const float distance = float(std::abs(edges[e] - i));
            if (distance > rule.deepest) break;
            if (!(rule.nearness[there] < rule.nearness[here] - rule.step)) continue;
            if (distance <= depth(here, there) + 1)
                add(here, line.at(mirrored(rule, line, i, edges[e], way)), there, 1 / (distance * distance));
            break;
        }
    }
}

/// Runs look_along over all rows, then all columns, in both directions. The calls for a pixel have
/// a fixed order.
template <typename Depth, typename Add>
void look_behind(const EdgeRule& rule, int width, int height, const Depth& depth, const Add& add) {
    const auto both_ways = [&](const PixelLine& line) {
        std::vector<int> edges;
        look_along(rule, line, 1, edges, depth, add);
        look_along(rule, line, -1, edges, depth, add);
    };
    const std::size_t stride = width;
    oneapi::tbb::parallel_for(0, height, [&](int y) { both_ways({y * stride, 1, width}); });
    oneapi::tbb::parallel_for(0, width, [&](int x) { both_ways({std::size_t(x), stride, height}); });
}

/// Colours behind edges, and additional values of the hidden surface; 0 where nothing is hidden.
struct HiddenSurface {
    std::vector<float> values, numbers;
    std::vector<float> weights;   // > 0 where a surface is hidden
};

/// Estimates colours and `per_pixel` values (such as motion) behind all edges.
template <typename Depth>
HiddenSurface hidden_surface(const EdgeRule& rule, const SpreadPicture& picture, std::span<const float> numbers,
                             int per_pixel, const Depth& depth) {
    HiddenSurface out{std::vector<float>(picture.values.size()), std::vector<float>(numbers.size()),
                      std::vector<float>(rule.nearness.size())};
    look_behind(rule, picture.width, picture.height, depth,
                [&](std::size_t i, std::size_t like, std::size_t edge, float weight) {
                    const float share = weight * picture.cover(like);   // colours are already premultiplied by
                                                                        // cover
                    if (!(share > 0) || !picture.finite(like)) return;
                    for (int c = 0; c < kSpreadColours; ++c)
                        out.values[kSpreadColours * i + c] += weight * picture.at(like)[c];
                    for (int c = 0; c < per_pixel; ++c)
                        out.numbers[per_pixel * i + c] += share * numbers[per_pixel * edge + c];
                    out.weights[i] += share;
                });
    for (std::size_t i = 0; i < out.weights.size(); ++i) {
        const float scale = out.weights[i] > 0 ? 1 / out.weights[i] : 0;
        for (int c = 0; c < kSpreadColours; ++c) out.values[kSpreadColours * i + c] *= scale;
        for (int c = 0; c < per_pixel; ++c) out.numbers[per_pixel * i + c] *= scale;
    }
    return out;
}

}  // namespace dg
