// pupil_region.h -- the part of the iris that the mounts leave visible from one film point (the cat's
// eye), covered by columns of equal area, so that a point in it is drawn by two look-ups.
#pragma once
#include <array>
#include <vector>

#include "optics/aim/aim_tables.h"

namespace dg {

/// low(x) <= y <= high(x): given at equally spaced x from -reach to reach, linear between; low > high where
/// nothing passes.
struct Outline {
    double reach = 1;
    std::vector<double> low, high;

    /// Nothing visible at any of the points.
    static Outline dark(double reach, int points);
    int points() const { return int(high.size()); }
    double x(int i) const { return reach * (2.0 * i / (points() - 1) - 1); }
    bool lit(int i) const { return low[i] < high[i]; }
    bool empty() const;
    /// Around both, and wider than that by a margin. Both must have the same reach and points.
    Outline joined(const Outline& other, double margin = 0) const;
    /// Wider by the margin, and by as much as a round rim bulges over the chords between points.
    Outline grown(double margin) const;
};

/// Columns k: x[k] <= x <= x[k+1], low[k] <= y <= high[k]; all of the same area, so that a column drawn
/// uniformly and a point drawn uniformly in it are a point drawn uniformly from all of them.
struct Columns {
    std::array<double, kColumns + 1> x{};
    std::array<double, kColumns> low{}, high{};
    double area = 0;   // of all together; 0: nothing to draw

    bool contain(double at_x, double at_y) const;
};

/// The columns of least area that cover the outline.
Columns cover(const Outline& outline);
Columns rectangle(double x0, double x1, double y0, double y1);

}  // namespace dg
