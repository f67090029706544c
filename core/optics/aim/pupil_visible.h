// pupil_visible.h -- what the mounts of a lens let through from one film point: the part of the iris, and
// the box of slopes around it.
#pragma once
#include <functional>

#include "optics/aim/pupil.h"
#include "optics/aim/pupil_region.h"

namespace dg {

/// Bounds hold at these wavelengths, nm; between them edges move little and evenly.
inline constexpr double kBoundWavelengths[] = {380, 550, 780};

struct Visible {
    Outline outline;   // iris_scale = 1
    bool jacobian_ok = true;   // of the sign `orientation` wherever the iris was looked at
};

/// Through `open` (mounts, no iris), from a film point in mm; `reach` is the radius around the iris,
/// iris_scale = 1. Conservative to the step of the search.
Visible visible_iris(const LensTables& open, const AimTables& aim, Vec2d film_mm, double reach,
                     double orientation);

/// The same from (film_mm, 0) through a symmetric lens, whose outline is the same above and below.
Visible visible_half_iris(const LensTables& open, const AimTables& aim, double film_mm, double reach,
                          double orientation);

struct SlopeBox {
    double x0 = 1e30, x1 = -1e30, y0 = 1e30, y1 = -1e30;
    bool empty() const { return x1 < x0; }
    void add(const SlopeBox& b);
    void grow(double x, double y);
};

/// Around the slopes that pass the mounts and reach the iris within `radius` mm, by search on grids in
/// range_at(reach), which widens until the box lies inside; empty if nothing passes.
SlopeBox passing_box(const LensTables& open, Vec2d film_mm, double radius,
                     const std::function<SlopeBox(double)>& range_at);

}  // namespace dg
