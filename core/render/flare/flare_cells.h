// flare_cells.h -- sampling distribution of front lens points and wavelengths for a pair of emitter and ghost.
#pragma once
#include "math/distribution.h"
#include "render/flare/flare_lambda.h"

namespace dg {

/// Rectangle in the square that bounds the front; the whole square by default.
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

/// Cells of a rectangle of the square. A defensive share of the paths is drawn outside the learned cells: half of it
/// uniformly in the rectangle of the first estimate, most of the rest in the rectangle where light of the source
/// enters, and the remainder in the whole square.
struct FlareCells {
    FlareRectangle inner, outer, front;
    Distribution2D weights;             // empty: uniform
    DiscreteDistribution wavelengths;   // over [0, 1) of Wavelengths::at; empty: uniform
    float blind = 1;

    /// Uniform over the rectangle where light enters.
    static FlareCells evenly(const FlareRectangle& front);

    Vec2f sample(Vec2f u) const;
    double pdf(Vec2f at) const;         // per unit of the square

    /// Defensive shares of the two rectangles.
    static constexpr float kOuter = 0.5f, kFront = 0.4f;

    FlareLambda lambda(float u) const;
};

}  // namespace dg
