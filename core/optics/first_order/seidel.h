// seidel.h -- third-order (Seidel) and first-order chromatic sums, per surface and in total.
#pragma once
#include <limits>
#include <vector>

#include "optics/first_order/paraxial.h"

namespace dg {

/// Wavefront coefficients in mm: W = S1/8 r^4 + S2/2 h r^2 y + S3/2 h^2 y^2 + (S3 + S4)/4 h^2 r^2 +
/// S5/2 h^3 y, with pupil coordinates and field h relative to their edges. C1/2 r^2 is the axial,
/// C2 h y the lateral difference of the wavefronts of two wavelengths.
struct SeidelSums {
    double s1 = 0, s2 = 0, s3 = 0, s4 = 0, s5 = 0, c1 = 0, c2 = 0;
};

struct Seidel {
    std::vector<SeidelSums> surfaces;
    SeidelSums total;
    double invariant;          // Lagrange invariant n (u h_chief - u_chief h), mm
    double image_convergence;  // n'u' of the marginal ray behind the lens; W has the transverse aberration dW/dy /
                               // (n'u')
};

/// Rays at the edges of pupil and field, to which the sums refer.
struct SeidelRays {
    double pupil_radius;  // mm, entrance pupil
    double field_slope;   // tangent of the chief ray's angle in front of the lens
    double object_distance = std::numeric_limits<double>::infinity();  // mm, from the entrance pupil
};

/// Seidel sums. Source: Welford, Aberrations of Optical Systems (1986), chapters 8 (surfaces and
/// aspheres) and 10 (colour). Aspheres contribute by the fourth-order term of their sag beyond the
/// sphere with the same vertex curvature; odd powers are ignored. Throws Error for lenses without
/// axial symmetry.
Seidel seidel(const Prescription& lens, double wavelength_nm, const SeidelRays& rays,
              double short_nm = 486.1327, double long_nm = 656.2725);

}  // namespace dg
