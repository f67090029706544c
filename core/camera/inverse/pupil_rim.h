// pupil_rim.h -- rim of the passing rays in a cell of a pupil's shape (pupil_shape.h), in units of
// its oval.
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Known rim of a cell: the highest and lowest record per fine column, and the outermost records.
struct Rim {
    static constexpr int kFine = 96;
    Vec2f left{1e30f, 0}, right{-1e30f, 0};
    std::array<Vec2f, kFine> top, bottom;  // bottom is stored with y negated

    Rim() { top.fill({0, -1e30f}), bottom.fill({0, -1e30f}); }
    bool lit() const { return left.x < right.x; }
    void widen(Vec2f p) {
        if (p.x < left.x) left = p;
        if (p.x > right.x) right = p;
    }
    void add(Vec2f p) {
        const int k =
            std::clamp(int((p.x - left.x) / (right.x - left.x) * kFine), 0, kFine - 1);
        if (p.y > top[k].y) top[k] = p;
        if (-p.y > bottom[k].y) bottom[k] = {p.x, -p.y};
    }
};

/// Upper convex hull, from left to right: openings of mounts and blades are nearly convex.
inline std::vector<Vec2f> hull(Vec2f left, std::span<const Vec2f> points, Vec2f right) {
    std::vector<Vec2f> h;
    const auto add = [&](Vec2f p) {
        while (h.size() > 1) {
            const Vec2f a = h[h.size() - 2], b = h.back();
            if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0) break;
            h.pop_back();
        }
        h.push_back(p);
    };
    add(left);
    for (const Vec2f p : points)
        if (p.y > -1e29f && p.x > left.x && p.x < right.x) add(p);
    add(right);
    return h;
}

/// Largest y of a hull over [a, b].
inline float highest(const std::vector<Vec2f>& h, float a, float b) {
    float high = -1e30f;
    for (std::size_t i = 0; i < h.size(); ++i) {
        if (h[i].x >= a && h[i].x <= b) high = std::max(high, h[i].y);
        if (i == 0) continue;
        const Vec2f p = h[i - 1], q = h[i];
        for (const float x : {a, b})
            if (p.x <= x && x <= q.x && p.x < q.x)
                high = std::max(high, p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x));
    }
    return high;
}

}  // namespace dg
