// fit_rays.h -- exact rays for fitting a lens, and their domain.
#pragma once
#include <optional>
#include <vector>

#include "optics/expansion/lens_fit.h"

namespace dg {

/// Exact ray with all quantities that a fit models.
struct FitSample {
    Vec2d f, q;  // unit coordinates
    Vec2d film, slope;
    double nm = 0, l = 0;
    Vec2d direction, offset, iris;
    double transmittance = 0;
    std::vector<Vec2d> met;  // optional: intersections with all surfaces in their local frames, mm
    bool passes = false;     // optional: inside the iris and all clear apertures
};

/// Whether the field is so wide that light may enter parallel to the glass. At its edge, the film
/// position depends as much on the offset as on the direction, so both need similar errors.
bool is_wide(const std::vector<FitSample>& clear);

/// Selection of rays.
struct FitDraw {
    int count = 0;
    int first = 0;       // first index in the low-discrepancy sequence
    double widened = 1;  // factor by which rays may exceed clear apertures and iris
    bool toward_edges =
        false;         // higher density at the edges of film, pupil and wavelengths, where polynomials err most
    bool met = false;  // computes `met` and `passes`
    double u_low = 0, u_high = 1;  // range of |f|^2
};

class FitRays {
  public:
    /// Finds the lit part of the film and the pupil, and sets the domain of `fit`: film, pupil,
    /// symmetry. Throws Error if no light reaches the film.
    FitRays(const Tracer& tracer, const LensFitRequest& request, LensFit& fit);

    /// Rays that reach the scene; may be fewer than requested.
    std::vector<FitSample> draw(const FitDraw& what) const;
    const Tracer& tracer() const { return tracer_; }

  private:
    void find_domain(LensFit& fit);
    std::optional<FitSample> trace(Vec2d f, Vec2d q, double nm,
                                   const FitDraw& what) const;
    bool add_met(const LensRay& scene, const LensIndices& index, FitSample& s) const;

    const Tracer& tracer_;
    const LensFitRequest& request_;
    LensFit& fit_;
    double outer_;  // mm, radius of the iris's bounding circle
    Iris round_;
};

}  // namespace dg
