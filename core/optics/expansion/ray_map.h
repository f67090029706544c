// ray_map.h -- polynomial map from rays to rays at one wavelength: Taylor expansion of an optical
// system about a base ray.
//
// A ray is (x, y, dx, dy) on a plane: a point in mm, and the x and y components of its unit
// direction (direction cosines). In a medium of index n, n times the cosines are the momenta
// conjugate to x and y, so maps are symplectic; slopes would make propagation linear instead. z
// points in the direction of travel: a mirror flips z, not x and y.
#pragma once
#include <array>

#include "optics/expansion/series.h"

namespace dg {

using RayNumbers = std::array<double, 4>;
using Matrix4x4 = std::array<RayNumbers, 4>;  // rows are outputs

/// `out` are series in the deviation from `origin`. Their constant terms are the end of the base
/// ray, where the following map must have its origin: then truncating both maps to degree n
/// truncates their composition exactly. Source: Hullin, Hanika and Heidrich 2012, Polynomial
/// Optics, CGF 31(4).
struct RayMap {
    RayNumbers origin{};
    std::array<Series, 4> out;

    int degree() const { return out[0].degree(); }
    RayNumbers image() const;
    RayNumbers evaluate(const RayNumbers& ray) const;
    Matrix4x4 jacobian(const RayNumbers& ray) const;
};

/// Coordinates of a ray as series about `about`: the input of all expansions.
std::array<Series, 4> ray_series(int degree, const RayNumbers& about);

RayMap truncated(const RayMap& map, int degree);

/// Composition second(first(ray)), to the lower of both degrees. Throws Error unless the origin of
/// `second` is the image of the base ray of `first`.
RayMap compose(const RayMap& second, const RayMap& first);

/// Inverse map; its composition with `map` is the identity up to the degree.
RayMap inverse(const RayMap& map);

}  // namespace dg
