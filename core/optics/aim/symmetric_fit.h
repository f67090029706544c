// symmetric_fit.h -- training rays for the aim of an axially symmetric lens, and the fit to them.
#pragma once
#include <optional>

#include "optics/aim/chief_map.h"
#include "optics/aim/pupil.h"

namespace dg {

/// Rays that the maker of an aim asks of the lens, in the meridional frame.
class SymmetricRays {
  public:
    /// `outer`: mm, radius around the enlarged iris. Error if no ray leads from the film's centre to it.
    SymmetricRays(const Tracer& tracer, const AimRequest& request, double outer);

    const Tracer& tracer() const { return tracer_; }
    /// Film slope toward an iris point (mm) from a film radius (mm): first order about the chief ray.
    Vec2d slope(double r, Vec2d iris) const;
    /// Fits `aim.slopes` and its tables at degree k. False, with nothing fitted, if too few rays reach the
    /// iris. A film far wider than the image circle is cut: tables.film_radius.
    bool fit(Aim& aim, int k);

  private:
    /// Up to a film radius, mm. Aberrations move the pupil: far from the axis, nothing paraxial leads there.
    void find_chiefs(double film_radius);
    std::optional<Vec2d> trace_iris(double r, Vec2d m, double nm) const;
    std::vector<SlopeSample> training(const AimTables& t, int count, int first) const;
    double lit_radius() const;

    const Tracer& tracer_;
    const AimRequest& request_;
    double outer_;
    double film_radius_ = 0;  // of chiefs_
    std::optional<ChiefMap> chiefs_;
};

}  // namespace dg
