// lens_fit.h -- lens as polynomials that map a film ray to a scene ray, iris point, mount points
// and transmittance.
//
// Source: Hanika and Dachsbacher 2014, Efficient Monte Carlo Rendering with Realistic Lenses, CGF
// 33(2), with the complete symmetric basis (fit_basis.h). Lens frame, mm. A film ray is the film
// point f and the slope m = (dx/dz, dy/dz). The slope enters through q = by_film f + by_slope m +
// shift, a linear coordinate in which the clear pupil fills the unit disc, followed by a bend of
// low degree. Fits never use the iris point as input: polynomials in film and iris points only
// serve aiming (pupil.h).
//
// The direction of the scene ray is v = theta (dx, dy) / sin(theta), where theta is the angle to
// the axis; it is smooth at and beyond 90 degrees. The offset e is the perpendicular from the
// centre of the entrance pupil to the ray, in the frame that the smallest rotation takes from the
// axis to the ray.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "optics/aim/chief_map.h"
#include "optics/expansion/fit_basis.h"
#include "optics/expansion/fit_error.h"
#include "optics/trace/lens_tables.h"

namespace dg {

/// Clear aperture that clips rays inside the iris.
struct FitMount {
    int surface = 0;
    double radius = 0, inner = 0;  // mm
};

/// Functions over common terms. Axial lenses: A and B interleaved per vector, or scalars; all in x.
/// Others: x components of the vectors in x, y components in y; scalars in x.
struct FitBlock {
    FitFunctions x, y;
};

/// Polynomials for a range of film radii: u = |f|^2 in [u_low, u_high).
struct FitSegment {
    double u_low = 0, u_high = 1;
    FitBlock bend;       // one vector, added to q for the direction (fit_bend.h); may be empty
    FitBlock direction;  // one vector, rad
    FitBlock points;     // vectors in mm: offset, iris point, and the hit on each mount in the mount's frame
    FitBlock light;      // one scalar, transmittance
};

/// Pupil coordinate q = by_film f + by_slope m + shift, with f in unit film coordinates.
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

/// Approximate map from scene ray to film ray, the start of Newton's method. g = v / direction and
/// h = by_film g + by_slope e + shift take the roles of f and q.
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
    double transmittance = 0;     // of the lens, without the iris
    std::vector<Vec2d> mounts{};  // mm
    bool within = false;  // inside film, pupil and mounts; ignores the iris
};

/// Direction v and offset e of a scene ray, relative to the pupil's centre on the axis.
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
                  1};  // mm: f = (film point - centre) / half; axial lenses: half is the film radius
    FitPupil pupil;
    double entrance_pupil_z = 0;              // mm
    double front_z = 0, front_curvature = 0;  // vertex and curvature of the sphere on which scene rays start
    double iris_radius = 0,
           iris_outer = 0;  // mm: radii of the circle of equal area and of the bounding circle
    std::vector<FitMount> mounts;
    std::vector<FitSegment> segments;
    FitInverse inverse;
    FitError error;

    Vec2d unit_film(Vec2d film_mm) const;
    /// q plus the bend of a segment.
    Vec2d bent(const FitSegment& segment, Vec2d f, Vec2d q, double l) const;
    FitVariables variables(Vec2d f, Vec2d q, double l, const FitSegment& segment) const;
    /// Segment that contains a film point (unit coordinates); the last segment beyond the film.
    const FitSegment& segment_at(Vec2d f) const;
    Vec2d direction(const FitSegment& segment, Vec2d f, Vec2d q, double l) const;
    FitDirection scene_vectors(const FitSegment& segment, Vec2d f, Vec2d q,
                               double l) const;
    FitValue evaluate(const FitRay& ray) const;
    /// Scene ray that starts on the front sphere, or at its point nearest to the pupil's centre if
    /// it misses the sphere.
    LensRay scene_ray(Vec2d direction, Vec2d offset) const;
    LensRay film_ray(const FitRay& ray) const;
    /// Film ray of a scene ray (directed toward the scene): the fitted inverse, refined by Newton's
    /// method. Empty if the iteration leaves the domain of the fit.
    std::optional<FitRay> to_film(const LensRay& scene, double wavelength_nm) const;
};

/// Vectors of a block: f A + q B, or separate polynomials for x and y.
void block_vectors(const FitBlock& block, const FitVariables& at, bool axial, Vec2d f,
                   Vec2d q, Vec2d* out);

FitDirection describe_ray(const LensRay& scene, double pupil_z);

/// Throws Error if a part lacks functions that other parts require, or contains unsupported powers.
void check_lens_fit(const LensFit& fit);

struct LensFitRequest {
    double film_z = 0;       // mm, lens frame
    double film_radius = 0;  // mm, farthest film point from the axis
    Iris iris;
    double iris_radius = 0;             // mm, circle of equal area
    std::optional<FilmPlane> tilted{};  // replaces film_z
    FilmRectangle film{};  // used part of the tilted film; half 0: all within film_radius
    int degree = 7;        // odd, 1 to 13
    int segments = 1;  // number of radial segments; the segment with the largest error is halved repeatedly
    int terms = 0;  // number of terms per vector by matching pursuit; 0: the complete basis
};

/// Fits exact rays in double; bitwise reproducible on all machines. Throws Error for an unsupported
/// degree, or if no light reaches the film.
LensFit make_lens_fit(const Tracer& tracer, const LensFitRequest& request);

/// Replaces the scene rays of a fit by a least-squares fit of the given ones in the same basis, and
/// updates the inverse. Keeps iris, mounts and transmittance; clears the error. For maps from other
/// sources, like Taylor expansions.
LensFit refit_rays(const LensFit& fit, const std::vector<FitRay>& rays,
                   const std::vector<FitDirection>& scene);

}  // namespace dg
