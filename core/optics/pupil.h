// pupil.h -- guided exact tracing: where to aim from the film so that most rays pass
// (aperture sampling: Hanika and Dachsbacher 2014, CGF 33(2)).
//
// A ray is drawn by choosing a point a of the iris (enlarged by 1 %) and looking up the
// film slope m(f, a, l) in a polynomial. The exact trace decides whether it passes. The
// density is that of the polynomial, m being one-to-one in a: so the fit's error costs
// efficiency and never bias.
#pragma once
#include "optics/polynomial.h"
#include "optics/trace_simd.h"

namespace dg {

inline constexpr double kEnlargement = 1.01;

struct AimRequest {
    double film_z = 0;       // mm, lens frame
    double film_radius = 0;  // mm, the farthest film point
    Iris iris;
    double iris_radius = 0;  // mm
    bool only_slope_boxes =
        false;  // skip the polynomial: exit-pupil boxes everywhere (comparison)
};

struct Aim {
    SlopePolynomial slopes;  // in units of tables.film_radius, tables.iris_scale
    AimTables tables;
    double fit_error = 0;       // largest |error| of m on fresh rays
    int fallback_segments = 0;  // film radii at which exit-pupil boxes are drawn instead
    bool covered = true;
};

/// Fits, bounds the mechanically visible part of the iris per film radius, and tests
/// coverage: every passing ray of a fresh set must lie inside the region that is drawn,
/// and the Jacobian must keep its sign there. The degree rises from 3 until that holds;
/// radii where it never does fall back.
Aim make_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
