// fit_rays.h -- exact rays for the fit of a lens, and the domain that they fill.
#pragma once
#include <optional>
#include <vector>

#include "optics/expansion/lens_fit.h"

namespace dg {

/// One ray of the exact lens, everything that a fit gives of it.
struct FitSample {
    Vec2d f, q;  // unit coordinates
    Vec2d film, slope;
    double nm = 0, l = 0;
    Vec2d direction, offset, iris;
    double transmittance = 0;
    std::vector<Vec2d> met;  // if asked for: each surface, in its own frame, mm
    bool passes = false;     // then: iris and clear apertures
};

/// Whether a field is so wide that light may enter along the glass: at its edge the film
/// feels the offset as much as the direction, and both should err alike.
bool is_wide(const std::vector<FitSample>& clear);

/// Which rays are drawn.
struct FitDraw {
    int count = 0;
    int first = 0;       // of the sequence
    double widened = 1;  // clear apertures and iris may be left by this factor
    bool toward_edges =
        false;         // of film, pupil and wavelengths, where polynomials err most
    bool met = false;  // whether `met` and `passes` are wanted
    double u_low = 0, u_high = 1;  // |f|^2
};

class FitRays {
  public:
    /// Finds what of the film is lit and where its light comes from, and sets the domain
    /// of `fit`: film, pupil, symmetry. Error if no light reaches the film.
    FitRays(const Tracer& tracer, const LensFitRequest& request, LensFit& fit);

    /// Rays that get through, fewer than asked for where few do.
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
    double outer_;  // mm, radius around the iris
    Iris round_;
};

}  // namespace dg
