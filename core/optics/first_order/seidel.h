// seidel.h -- third-order (Seidel) and first-order chromatic sums, surface by surface.
#pragma once
#include <limits>
#include <vector>

#include "optics/first_order/paraxial.h"

namespace dg {

/// mm of wavefront: W = S1/8 r^4 + S2/2 h r^2 y + S3/2 h^2 y^2 + (S3 + S4)/4 h^2 r^2 +
/// S5/2 h^3 y, with pupil coordinates and field h in units of their edges. C1/2 r^2 is the
/// step in wavefront between two wavelengths on the axis, C2 h y across it.
struct SeidelSums {
    double s1 = 0, s2 = 0, s3 = 0, s4 = 0, s5 = 0, c1 = 0, c2 = 0;
};

struct Seidel {
    std::vector<SeidelSums> surfaces;
    SeidelSums total;
    double invariant;          // Lagrange: n (u h_chief - u_chief h), mm
    double image_convergence;  // n'u' of the marginal ray behind the lens: the transverse
                               // aberration of W is dW/dy / (n'u')
};

/// The rays that the sums belong to: the edge of the pupil and the edge of the field.
struct SeidelRays {
    double pupil_radius;  // mm, of the entrance pupil
    double field_slope;   // tangent of the chief ray's angle in front of the lens
    double object_distance = std::numeric_limits<double>::infinity();  // mm, from that pupil
};

/// Source: Welford, Aberrations of Optical Systems (1986), chapters 8 (surfaces and
/// aspheres) and 10 (colour). An even asphere adds by the fourth-order depth that its sag
/// has beyond the sphere of the same curvature at the vertex; odd powers have no share. Error
/// for lenses without axial symmetry.
Seidel seidel(const Prescription& lens, double wavelength_nm, const SeidelRays& rays,
              double short_nm = 486.1327, double long_nm = 656.2725);

}  // namespace dg
