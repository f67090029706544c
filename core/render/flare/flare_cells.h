// flare_cells.h -- through which part of the front lens, and at which wavelengths, light of one emitter and ghost
// comes: what places on the front and wavelengths are drawn by.
#pragma once
#include "math/distribution.h"
#include "render/flare/flare_lambda.h"

namespace dg {

/// Rectangle in the square that holds the front; all of it by default.
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

/// Cells of a rectangle of the square. A share of the paths goes elsewhere: half of it to what was first thought
/// to hold the light, most of the rest to where any light of the source comes in, and some to all of the square.
struct FlareCells {
    FlareRectangle inner, outer, front;
    Distribution2D weights;             // empty: evenly
    DiscreteDistribution wavelengths;   // over [0, 1) of Wavelengths::at; empty: evenly
    float blind = 1;

    /// Where nothing is known but where light comes in.
    static FlareCells evenly(const FlareRectangle& front);

    Vec2f sample(Vec2f u) const;
    double pdf(Vec2f at) const;         // per unit of the square

    /// Shares that are drawn without knowledge of cells.
    static constexpr float kOuter = 0.5f, kFront = 0.4f;

    FlareLambda lambda(float u) const;
};

}  // namespace dg
