// pupil_region.h -- the part of the iris that the mounts leave visible from one film radius (the cat's
// eye), covered by columns of equal area, so that a point in it is drawn by two look-ups.
//
// Frame: the meridional plane is y = 0, and everything is symmetric about it.
#pragma once
#include <array>

#include "optics/pupil_tables.h"

namespace dg {

/// |y| <= half(x): given at equally spaced x from -reach to reach, linear between; 0 where nothing passes.
struct Outline {
    static constexpr int kPoints = 97;
    double reach = 1;
    std::array<double, kPoints> half{};

    double x(int i) const { return reach * (2.0 * i / (kPoints - 1) - 1); }
    /// Largest half on [a, b].
    double largest(double a, double b) const;
    bool empty() const { return !(largest(-reach, reach) > 0); }
    /// Around both, and wider than that by a margin. Both must have the same reach.
    Outline joined(const Outline& other, double margin) const;
};

/// Columns k: x[k] <= x <= x[k+1], |y| <= half[k]; all of the same area, so that a column drawn uniformly
/// and a point drawn uniformly in it are a point drawn uniformly from all of them.
struct Columns {
    std::array<double, kColumns + 1> x{};
    std::array<double, kColumns> half{};
    double area = 0;   // of all together; 0: nothing to draw

    bool contain(double at_x, double at_y) const;
};

/// The columns of least area that cover the outline.
Columns cover(const Outline& outline);
/// A rectangle, |y| <= half.
Columns rectangle(double x0, double x1, double half);

}  // namespace dg
