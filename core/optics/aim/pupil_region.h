// pupil_region.h -- region of the iris visible from a film point past the mounts (the cat's eye),
// covered by columns of equal area; two table look-ups sample it.
#pragma once
#include <array>
#include <vector>

#include "optics/aim/aim_tables.h"

namespace dg {

/// Region low(x) <= y <= high(x), sampled at equally spaced x from -reach to reach and linear
/// between; empty where low > high.
struct Outline {
    double reach = 1;
    std::vector<double> low, high;

    /// Empty outline.
    static Outline dark(double reach, int points);
    int points() const { return int(high.size()); }
    double x(int i) const { return reach * (2.0 * i / (points() - 1) - 1); }
    bool lit(int i) const { return low[i] < high[i]; }
    bool empty() const;
    /// Hull of both outlines, enlarged by a margin. Both must have the same reach and number of
    /// points.
    Outline joined(const Outline& other, double margin = 0) const;
    /// Outline enlarged by the margin and by the bulge of a round rim over the chords between
    /// points.
    Outline grown(double margin) const;
};

/// Columns x[k] <= x <= x[k+1], low[k] <= y <= high[k] of equal area: a uniform point in a
/// uniformly chosen column is uniform over their union.
struct Columns {
    std::array<double, kColumns + 1> x{};
    std::array<double, kColumns> low{}, high{};
    double area = 0;   // total area; 0: empty

    bool contain(double at_x, double at_y) const;
};

/// Columns of least area that cover the outline.
Columns cover(const Outline& outline);
Columns rectangle(double x0, double x1, double y0, double y1);

}  // namespace dg
