// sheet_level.h -- chooses the node spacing for the light of a ghost.
//
// Light on nodes p px apart is blurred by a kernel of variance v = 5/12 p^2 (a tent, then a quadratic B-spline). If v
// varies over the frame, uniform light changes by v'' / 2. So v, rather than p, must vary slowly with the distance from
// an edge.
#pragma once
#include <vector>

#include "optics/stray/ghost_lens.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// Smoothness of a ghost, without the sharpest part of its light.
struct SheetSmooth {
    float edge = 0, even = 0;   // px; see CellBlur
    struct CellLight {
        const CellBlur* blur;
        double light;
    };
    static SheetSmooth of(std::vector<CellLight> cells);
};

class SheetLevel {
  public:
    static constexpr int kMost = 4;   // a spacing of 16 px

    /// `crossings`: of the iris. `filled`: lit fraction of the source's circle.
    SheetLevel(int crossings, const GhostLens& lens, const Sensor& sensor, float filled, const SheetSmooth& smooth);
    /// Fractional level of landing i in a cell with that blur. The spacing is 2^level px; the fractional part is the
    /// probability of the next coarser level, which makes v correct on average.
    float of(const CellBlur& blur, const MapBatch& batch, int i) const;
    /// Level of light without a map: half the spacing of most other light.
    float of_rays() const;
    /// Node spacing for the blur of a cell's edges, px.
    float pitch(const CellBlur& blur) const;

  private:
    float from_edge(const CellBlur& blur, const MapBatch& batch, int i) const;

    int crossings_;
    SheetSmooth smooth_;
    float filled_, apothem_;   // mm
    float most_;               // px2: largest variance of a kernel
};

}  // namespace dg
