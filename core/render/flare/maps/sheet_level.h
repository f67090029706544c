// sheet_level.h -- how coarse the light of a ghost may be where it lands.
//
// Light that lands on nodes p px apart is spread over them by a kernel of the variance v = 5/12 p^2 (a tent, and then a
// parabola). What this does to even light is v'' / 2 where v differs from place to place: so it is v that grows slowly
// with the distance from an edge, and not the pitch.
#pragma once
#include <vector>

#include "optics/stray/ghost_lens.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// How smooth a ghost is: all but the sharpest part of its light.
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
    static constexpr int kMost = 4;   // 16 px from node to node

    /// `crossings`: of the iris; `filled`: of the source's circle.
    SheetLevel(int crossings, const GhostLens& lens, const Sensor& sensor, float filled, const SheetSmooth& smooth);
    /// Level of one of a batch of landings in a cell with that blur: 2^l px is the pitch, and the part after the point the
    /// chance of the next coarser one, with which v is right in the mean.
    float of(const CellBlur& blur, const MapBatch& batch, int i) const;
    /// Level of light of which there is no map: half the pitch of most of the rest.
    float of_rays() const;
    /// Pitch for the blur of a cell's edges, px.
    float pitch(const CellBlur& blur) const;

  private:
    float from_edge(const CellBlur& blur, const MapBatch& batch, int i) const;

    int crossings_;
    SheetSmooth smooth_;
    float filled_, apothem_;   // mm
    float most_;               // px2, of a kernel
};

}  // namespace dg
