// pupil_visible.h -- visibility from a film point past the mounts of a lens: region of the iris,
// and bounding box of the slopes.
#pragma once
#include <functional>

#include "optics/aim/pupil.h"
#include "optics/aim/pupil_region.h"

namespace dg {

/// Wavelengths in nm at which visibility is tested. Between them edges move little and smoothly.
inline constexpr double kBoundWavelengths[] = {380, 550, 780};

struct Visible {
    Outline outline;   // in units of iris_scale
    bool jacobian_ok = true;   // whether the Jacobian has the sign `orientation` at all tested points
};

/// Visible region of the iris from a film point in mm through `open` (mounts without the iris).
/// `reach` is the radius of the iris in units of iris_scale. Conservative to the step of the
/// search.
Visible visible_iris(const LensTables& open, const AimTables& aim, Vec2d film_mm, double reach,
                     double orientation);

/// Visible region from (film_mm, 0) through a symmetric lens; its outline is symmetric in y.
Visible visible_half_iris(const LensTables& open, const AimTables& aim, double film_mm, double reach,
                          double orientation);

struct SlopeBox {
    double x0 = 1e30, x1 = -1e30, y0 = 1e30, y1 = -1e30;
    bool empty() const { return x1 < x0; }
    void add(const SlopeBox& b);
    void grow(double x, double y);
};

/// Bounding box of the slopes that pass the mounts and reach the iris within `radius` mm. Searches
/// grids over range_at(reach) and increases `reach` until the box is inside; empty if no slope
/// passes.
SlopeBox passing_box(const LensTables& open, Vec2d film_mm, double radius,
                     const std::function<SlopeBox(double)>& range_at);

}  // namespace dg
