// system.h -- optical system as a polynomial in the coordinates of a ray and in wavelength.
//
// The dependence on wavelength is stored as expansions at a few nodes; coefficients are
// interpolated by the polynomial in 1/wavelength^2 through the nodes. Composition is thus exact at
// the nodes, without truncation in wavelength.
#pragma once
#include <span>
#include <vector>

#include "optics/expansion/lens_map.h"

namespace dg {

/// A map per node, or a single map without nodes for all wavelengths.
struct PolynomialSystem {
    std::vector<double> nm;  // nodes, ascending
    std::vector<RayMap> maps;

    int degree() const { return maps.front().degree(); }
    /// Throws Error unless the wavelength is within the nodes.
    RayMap at(double wavelength_nm) const;
};

void check(const PolynomialSystem& system);

/// `count` Chebyshev nodes in 1/wavelength^2 between two wavelengths, ends included: close to the
/// best nodes for interpolation.
std::vector<double> wavelength_nodes(double from_nm, double to_nm, int count);

/// Composition second(first). Both must have the same nodes, unless one has none.
PolynomialSystem compose(const PolynomialSystem& second, const PolynomialSystem& first);
PolynomialSystem inverse(const PolynomialSystem& system);
PolynomialSystem truncated(const PolynomialSystem& system, int degree);

/// Expansion of the lens with the wavelengths as nodes.
PolynomialSystem lens_system(const Tracer& tracer, const LensWay& way,
                             const std::vector<double>& nm, int degree);

}  // namespace dg
