// fit_rays.h -- exact rays for the fit of a lens, and the domain that they fill.
#pragma once
#include <optional>
#include <vector>

#include "optics/polynomial/lens_fit.h"

namespace dg {

/// One ray of the exact lens, everything that a fit gives of it.
struct FitSample {
    Vec2d f, q;  // unit coordinates
    Vec2d film, slope;
    double nm = 0, l = 0;
    Vec2d direction, offset, iris;
    double transmittance = 0;
    std::vector<Vec2d> met;  // each surface, in its own frame, mm
    bool passes = false;     // iris and clear apertures
};

/// How rays are spread over film, pupil and wavelength.
enum class FitSpread { uniform, toward_edges };

class FitRays {
  public:
    /// Finds what of the film is lit and where its light comes from, and sets the domain of `fit`: film, pupil,
    /// symmetry. Error if no light reaches the film.
    FitRays(const Tracer& tracer, const LensFitRequest& request, LensFit& fit);

    /// Up to `count` rays of the sequence that starts at `first` which pass clear apertures and iris widened by
    /// the factor; film points with |f|^2 in [u_low, u_high]. `tries`: how many were looked at.
    std::vector<FitSample> draw(int count, int first, double widened, FitSpread spread, double u_low,
                                double u_high, int* tries = nullptr) const;
    const Tracer& tracer() const { return tracer_; }

  private:
    void find_domain(LensFit& fit);
    std::optional<FitSample> trace(Vec2d f, Vec2d q, double nm, double widened) const;

    const Tracer& tracer_;
    const LensFitRequest& request_;
    LensFit& fit_;
    double outer_;  // mm, radius around the iris
    Iris round_;
};

}  // namespace dg
