// symmetric_fit.h -- training rays for the aim of an axially symmetric lens, and the polynomial
// fit.
#pragma once
#include <optional>

#include "optics/aim/chief_map.h"
#include "optics/aim/pupil.h"

namespace dg {

/// Training rays in the meridional frame.
class SymmetricRays {
  public:
    /// `outer`: mm, radius of the enlarged iris. Throws Error if no ray leads from the film's
    /// centre to the iris.
    SymmetricRays(const Tracer& tracer, const AimRequest& request, double outer);

    const Tracer& tracer() const { return tracer_; }
    /// Film slope toward an iris point (mm) from a film radius (mm), to first order about the chief
    /// ray.
    Vec2d slope(double r, Vec2d iris) const;
    /// Fits `aim.slopes` and its tables at degree k. Returns false, without a fit, if too few rays
    /// reach the iris. Reduces tables.film_radius if the film is far larger than the image circle.
    bool fit(Aim& aim, int k);

  private:
    /// Finds chief rays up to a film radius (mm). Pupil aberration rules out paraxial chief rays
    /// far from the axis.
    void find_chiefs(double film_radius);
    std::optional<Vec2d> trace_iris(double r, Vec2d m, double nm) const;
    std::vector<SlopeSample> training(const AimTables& t, int count, int first) const;
    double lit_radius() const;

    const Tracer& tracer_;
    const AimRequest& request_;
    double outer_;
    double film_radius_ = 0;  // mm, range of chiefs_
    std::optional<ChiefMap> chiefs_;
};

}  // namespace dg
