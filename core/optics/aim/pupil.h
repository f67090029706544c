// pupil.h -- guided exact tracing: where to aim from the film so that most rays pass
// (aperture sampling: Hanika and Dachsbacher 2014, CGF 33(2)).
//
// A ray is drawn by choosing a point a of the iris (a little enlarged) and looking up the
// film slope m(f, a, l) in a polynomial. The exact trace decides whether it passes. The
// density is that of the polynomial, m being one-to-one in a: so the fit's error costs
// efficiency and never bias.
#pragma once
#include <optional>

#include "optics/aim/aim_simd.h"
#include "optics/aim/chief_map.h"
#include "optics/aim/free_basis.h"
#include "optics/aim/symmetric_basis.h"

namespace dg {

/// The iris is drawn larger by this factor at most; by how much follows from the fit's error.
inline constexpr double kEnlargement = 1.01;
/// Fits reach this far beyond that.
inline constexpr double kShapeMargin = 1.02;
/// Training rays may leave the clear diameters by this factor, so that the fit is not cut off at the edge
/// of what passes. Farther outside aspheres go wild, and rays can reach the iris a second time (a fold),
/// which no one-to-one map follows.
inline constexpr double kWidened = 1.05;

/// Part of a lens that is drawn. All but the first are there to be compared with.
enum class PupilDraw : std::uint8_t {
    aimed,        // the iris, through polynomials
    slope_boxes,  // a box of slopes around what passes
    rear_disc,    // the whole last surface (symmetric lenses; for others as slope_boxes)
};

struct AimRequest {
    double film_z = 0;       // mm, lens frame
    double film_radius = 0;  // mm, the farthest film point
    Iris iris;
    double iris_radius = 0;  // mm
    PupilDraw draw = PupilDraw::aimed;
    std::optional<FilmPlane> tilted{};  // instead of film_z
    FilmRectangle film{};  // its part that is asked for; half 0: all within film_radius
};

struct Aim {
    SlopePolynomial slopes;  // in units of tables.film_radius, tables.iris_scale
    FreePolynomial free_slopes;  // of a lens without symmetry, or with a tilted film
    AimTables tables;
    double fit_error = 0;       // largest |error| of m on fresh rays
    double iris_error = 0;      // the same on the iris, in units of its scale
    int fallback_segments = 0;  // film radii or cells where exit-pupil boxes are drawn instead
    bool covered = true;
};

/// Radius around the largest iris that is drawn, mm.
double outer_radius(const AimRequest& request);
/// Scales of the iris in empty tables, and what is drawn of it once the fit's error is known.
void set_iris_scale(AimTables& tables, const AimRequest& request);
void set_enlargement(AimTables& tables, const AimRequest& request, double iris_error);

/// Fits, bounds the mechanically visible part of the iris per film radius, and tests
/// coverage: every passing ray of a fresh set must lie inside the region that is drawn,
/// and the Jacobian must keep its sign there. The degree rises from 3 until that holds;
/// radii where it never does fall back.
Aim make_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
