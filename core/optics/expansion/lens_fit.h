// lens_fit.h -- a lens as polynomials: film ray in, scene ray, iris point, mounts and
// transmittance out.
//
// Source: Hanika and Dachsbacher 2014, Efficient Monte Carlo Rendering with Realistic
// Lenses, CGF 33(2), with the complete symmetric basis (fit_basis.h). Lens frame, mm; the
// film ray is the film point f and the slope m = (dx/dz, dy/dz). The slope enters through
// q = by_film f + by_slope m + shift, a linear change of the film ray under which the
// clear pupil fills the unit disc, and then a bend of low degree. A lens is never fitted
// from a film point and an iris point: those polynomials only aim (pupil.h).
//
// The scene ray: its direction as v = theta (dx, dy) / sin(theta), theta the angle to the
// axis, which has no limit at 90 degrees; and its offset e from the middle of the
// entrance pupil, across the ray, in the frame that the smallest turn from the axis to
// the ray carries along.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "optics/aim/chief_map.h"
#include "optics/expansion/fit_basis.h"
#include "optics/expansion/fit_error.h"
#include "optics/trace/lens_tables.h"

namespace dg {

/// A clear aperture that stops rays which the iris lets through.
struct FitMount {
    int surface = 0;
    double radius = 0, inner = 0;  // mm
};

/// Functions over one set of terms. Axial lenses: A and B in turn for each vector, or the
/// scalars, all in x. Others: the x of each vector in x, the y in y; scalars in x.
struct FitBlock {
    FitFunctions x, y;
};

/// The fit over a range of film radii: segments own [u_low, u_high) of u = |f|^2.
struct FitSegment {
    double u_low = 0, u_high = 1;
    FitBlock bend;       // one vector, added to q before the direction reads it
                         // (fit_bend.h); may be empty
    FitBlock direction;  // one vector (rad)
    FitBlock points;     // offset, iris point, then where each mount is met, in the
                         // mount's own frame (mm)
    FitBlock light;      // transmittance
};

/// q = by_film f + by_slope m + shift, f in units of the film.
struct FitPupil {
    Vec2d by_film{}, by_slope{1, 1}, shift{};
    Vec2d q(Vec2d f, Vec2d m) const {
        return {by_film.x * f.x + by_slope.x * m.x + shift.x,
                by_film.y * f.y + by_slope.y * m.y + shift.y};
    }
    Vec2d slope(Vec2d f, Vec2d q) const {
        return {(q.x - by_film.x * f.x - shift.x) / by_slope.x,
                (q.y - by_film.y * f.y - shift.y) / by_slope.y};
    }
};

/// Scene ray to film ray, where Newton's search begins: g = v / direction, h = by_film g
/// + by_slope e + shift take the places of f and q.
struct FitInverse {
    double direction = 1;  // rad
    FitPupil pupil;
    FitBlock rays;  // f, q
};

struct FitRay {
    Vec2d film, slope;  // mm on the film; dx/dz, dy/dz
    double wavelength_nm = 587.5618;
};

struct FitValue {
    Vec2d direction, offset, iris;
    double transmittance = 0;     // of the glass
    std::vector<Vec2d> mounts{};  // mm
    bool within = false;  // of film, pupil and mounts; the iris shape is not asked
};

/// v and e of a scene ray, about a pupil's middle on the axis.
struct FitDirection {
    Vec2d direction, offset;
};

struct LensFit {
    std::string lens;
    int degree = 7;
    FitSymmetry symmetry;
    WavelengthScale scale = WavelengthScale::visible();
    FilmPlane film;  // lens frame
    Vec2d film_center{},
        film_half{1,
                  1};  // mm: f = (film point - centre) / half; axial: half is the radius
    FitPupil pupil;
    double entrance_pupil_z = 0;              // mm
    double front_z = 0, front_curvature = 0;  // of the sphere on which scene rays start
    double iris_radius = 0,
           iris_outer = 0;  // mm: of the circle of equal area, around the shape
    std::vector<FitMount> mounts;
    std::vector<FitSegment> segments;
    FitInverse inverse;
    FitError error;

    Vec2d unit_film(Vec2d film_mm) const;
    /// q with a segment's bend.
    Vec2d bent(const FitSegment& segment, Vec2d f, Vec2d q, double l) const;
    FitVariables variables(Vec2d f, Vec2d q, double l, const FitSegment& segment) const;
    /// Which segment owns a film point (unit coordinates); the last one beyond the film.
    const FitSegment& segment_at(Vec2d f) const;
    Vec2d direction(const FitSegment& segment, Vec2d f, Vec2d q, double l) const;
    FitDirection scene_vectors(const FitSegment& segment, Vec2d f, Vec2d q,
                               double l) const;
    FitValue evaluate(const FitRay& ray) const;
    /// From the sphere at the front, or where it is missed from the point nearest the
    /// pupil's middle.
    LensRay scene_ray(Vec2d direction, Vec2d offset) const;
    LensRay film_ray(const FitRay& ray) const;
    /// Film ray of a scene ray (toward the scene): the fitted inverse, then Newton with
    /// evaluate()'s derivatives. Nothing if the search leaves the fit's domain.
    std::optional<FitRay> to_film(const LensRay& scene, double wavelength_nm) const;
};

/// The vectors of a block: f A + q B, or x and y apart.
void block_vectors(const FitBlock& block, const FitVariables& at, bool axial, Vec2d f,
                   Vec2d q, Vec2d* out);

FitDirection describe_ray(const LensRay& scene, double pupil_z);

/// Error if a part has not the functions that the others ask for, or powers that are not
/// kept.
void check_lens_fit(const LensFit& fit);

struct LensFitRequest {
    double film_z = 0;       // mm, lens frame
    double film_radius = 0;  // mm, the farthest film point
    Iris iris;
    double iris_radius = 0;             // mm, of the circle of equal area
    std::optional<FilmPlane> tilted{};  // instead of film_z
    FilmRectangle film{};  // its part that is asked for; half 0: all within film_radius
    int degree = 7;        // odd, 1 to 13
    int segments = 1;  // of the film's radius, the worst halved until there are as many
    int terms = 0;  // for each vector, chosen one after the other; 0: the complete basis
};

/// Fits exact rays in double: the same bits on every machine. Error if the degree is not
/// one of those, or if no light reaches the film.
LensFit make_lens_fit(const Tracer& tracer, const LensFitRequest& request);

/// The fit with other scene rays: least squares of given ones in the same basis, and
/// their inverse; iris, mounts and light stay, and its error is no longer known. For maps
/// from elsewhere, such as Taylor's.
LensFit refit_rays(const LensFit& fit, const std::vector<FitRay>& rays,
                   const std::vector<FitDirection>& scene);

}  // namespace dg
