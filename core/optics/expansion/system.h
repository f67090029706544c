// system.h -- an optical system as a polynomial in a ray's four numbers and the
// wavelength.
//
// The wavelength enters through expansions at a few nodes: between them the coefficients
// are the polynomial in 1/wavelength^2 through the nodes. So composition is exact at the
// nodes, and no degree in the wavelength has to be cut on the way.
#pragma once
#include <span>
#include <vector>

#include "optics/expansion/lens_map.h"

namespace dg {

/// One map for each node. Without nodes: one map, the same at any wavelength.
struct PolynomialSystem {
    std::vector<double> nm;  // nodes, ascending
    std::vector<RayMap> maps;

    int degree() const { return maps.front().degree(); }
    /// Throws Error unless the nodes ascend and the wavelength lies between them.
    RayMap at(double wavelength_nm) const;
};

void check(const PolynomialSystem& system);

/// `count` nodes that keep the interpolation between two wavelengths near the best: those
/// of Chebyshev, in 1/wavelength^2, ends included.
std::vector<double> wavelength_nodes(double from_nm, double to_nm, int count);

/// First `first`. Both have the same nodes, or one of them none.
PolynomialSystem compose(const PolynomialSystem& second, const PolynomialSystem& first);
PolynomialSystem inverse(const PolynomialSystem& system);
PolynomialSystem truncated(const PolynomialSystem& system, int degree);

/// At each of the wavelengths as a node.
PolynomialSystem lens_system(const Tracer& tracer, const LensWay& way,
                             const std::vector<double>& nm, int degree);

}  // namespace dg
