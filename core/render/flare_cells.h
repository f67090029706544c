// flare_cells.h -- through which part of the front lens light of one emitter and ghost comes: what places on the
// front are drawn by.
#pragma once
#include "math/distribution.h"

namespace dg {

/// Of the square that holds the front; all of it by default.
struct FlareRectangle {
    Vec2f low{-1, -1}, size{2, 2};

    Vec2f at(Vec2f u) const { return {low.x + size.x * u.x, low.y + size.y * u.y}; }
    Vec2f in(Vec2f p) const { return {(p.x - low.x) / size.x, (p.y - low.y) / size.y}; }
    float area() const { return size.x * size.y; }
    bool holds(Vec2f p) const {
        const Vec2f u = in(p);
        return u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1;
    }
};

/// Cells of a rectangle of the square. A share of the paths goes to what was first thought to hold the light,
/// and to all of the square: the larger, the less is known.
struct FlareCells {
    FlareRectangle inner, outer;
    Distribution2D weights;
    float blind = 1;

    Vec2f sample(Vec2f u) const;
    double pdf(Vec2f at) const;   // per unit of the square
};

}  // namespace dg
