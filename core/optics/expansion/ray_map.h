// ray_map.h -- a polynomial from rays to rays at one wavelength: the Taylor expansion of
// an optical system about one ray, its base.
//
// A ray is (x, y, dx, dy) on a plane: a point in mm, and x and y of its unit direction
// (its cosines). In a medium of index n the cosines times n are the momenta that belong
// to x and y, so that systems are symplectic; slopes would have made propagation linear
// instead. z runs the way that light goes: a mirror turns z, not x and y.
#pragma once
#include <array>

#include "optics/expansion/series.h"

namespace dg {

using RayNumbers = std::array<double, 4>;
using Matrix4x4 = std::array<RayNumbers, 4>;  // rows are outputs

/// `out` are series in the deviation from `origin`. Their constants are where the base
/// ray ends, so that none arise where a map of that origin follows: what is cut from both
/// at degree n is then cut from their composition as well. Source: Hullin, Hanika and
/// Heidrich 2012, Polynomial Optics, CGF 31(4).
struct RayMap {
    RayNumbers origin{};
    std::array<Series, 4> out;

    int degree() const { return out[0].degree(); }
    RayNumbers image() const;
    RayNumbers evaluate(const RayNumbers& ray) const;
    Matrix4x4 jacobian(const RayNumbers& ray) const;
};

/// The variables themselves, about a ray: where all expansions start.
std::array<Series, 4> ray_series(int degree, const RayNumbers& about);

RayMap truncated(const RayMap& map, int degree);

/// First `first`, then `second`, to the lower degree of both. Error unless the second is
/// expanded about the ray on which the first ends.
RayMap compose(const RayMap& second, const RayMap& first);

/// From the image to the origin: composed with the map, the identity up to its degree.
RayMap inverse(const RayMap& map);

}  // namespace dg
