// pupil.h -- guided exact tracing: importance sampling of film slopes such that most rays pass the
// lens (aperture sampling: Hanika and Dachsbacher 2014, CGF 33(2)).
//
// A sample is a point a of the slightly enlarged iris; a polynomial maps it to the film slope m(f,
// a, l), and the exact trace decides whether the ray passes. The density comes from the polynomial,
// which is one-to-one in a, so an error of the fit costs efficiency but never adds bias.
// efficiency and never bias.
#pragma once
#include <optional>

#include "optics/aim/aim_simd.h"
#include "optics/aim/chief_map.h"
#include "optics/aim/free_basis.h"
#include "optics/aim/symmetric_basis.h"

namespace dg {

/// Largest factor by which the sampled iris is enlarged; the factor follows from the error of the
/// fit.
inline constexpr double kEnlargement = 1.01;
/// Fits extend beyond the enlarged iris by this factor.
inline constexpr double kShapeMargin = 1.02;
/// Factor by which training rays may exceed the clear diameters, so that the fit extends past the
/// edge of the passing rays. Farther out, aspheres diverge and rays can reach an iris point twice
/// (a fold), which a one-to-one map cannot represent.
inline constexpr double kWidened = 1.05;

/// Sampled part of the lens. All but the first are for comparison.
enum class PupilDraw : std::uint8_t {
    aimed,        // the iris, through the polynomials
    slope_boxes,  // a bounding box of the passing slopes
    rear_disc,    // the whole last surface (symmetric lenses; otherwise slope_boxes)
};

struct AimRequest {
    double film_z = 0;       // mm, lens frame
    double film_radius = 0;  // mm, farthest film point from the axis
    Iris iris;
    double iris_radius = 0;  // mm
    PupilDraw draw = PupilDraw::aimed;
    std::optional<FilmPlane> tilted{};  // replaces film_z
    FilmRectangle film{};  // used part of the tilted film; half 0: all within film_radius
};

struct Aim {
    SlopePolynomial slopes;  // in units of tables.film_radius and tables.iris_scale
    FreePolynomial free_slopes;  // for a lens without symmetry or a tilted film
    AimTables tables;
    double fit_error = 0;       // largest |error| of m on fresh rays
    double iris_error = 0;      // largest error on the iris, in units of its scale
    int fallback_segments = 0;  // radial segments or cells that sample boxes of slopes instead
    bool covered = true;
};

/// Radius of the iris at its largest enlargement, mm.
double outer_radius(const AimRequest& request);
/// Sets the scales of the iris in new tables.
void set_iris_scale(AimTables& tables, const AimRequest& request);
/// Sets the enlargement of the sampled iris from the error of the fit on the iris.
void set_enlargement(AimTables& tables, const AimRequest& request, double iris_error);

/// Fits the aim, bounds the visible part of the iris per film radius, and tests coverage: all
/// passing rays of a fresh set must be in the sampling domain, where the Jacobian must not change
/// sign. The degree rises from 3 until both hold; radii at which they never hold fall back to boxes
/// of slopes.
Aim make_aim(const Tracer& tracer, const AimRequest& request);

}  // namespace dg
