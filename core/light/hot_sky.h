// hot_sky.h -- samples the bright spots of an environment's picture that a lens sees: sun, street lamps, windows.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/environment.h"
#include "light/view_cone.h"
#include "math/distribution.h"

namespace dg {

/// Cells of the picture (sky_grid.h) in the field of view that are much brighter than its mean, sampled by
/// luminance. Excludes the remaining picture, which camera paths sample well.
class HotSky {
  public:
    HotSky() = default;
    HotSky(const Environment& environment, std::span<const ViewCone> views);

    /// Illuminance by all spots on a facing surface, lux.
    double illuminance() const { return cells_.empty() ? 0 : strength_ * cells_.sum(); }
    /// World directions and densities (1/sr) at a time; pdf is 0 outside the spots.
    Environment::Sample sample(Vec2f u, float time) const;
    float pdf(Vec3f direction, float time) const;
    bool empty() const { return cells_.empty(); }

    /// Divides the spots by regions of the sky of 22.5 degrees: at most `most` parts for the brightest regions, and a
    /// part for the rest. Samples and densities of a part are normalized for that part.
    std::vector<HotSky> parts(int most) const;

  private:
    void mark_hot();

    Environment environment_;
    double strength_ = 1;               // largest strength of the environment
    DiscreteDistribution cells_;
    std::vector<std::uint32_t> index_;  // indices of the cells, row by row, ascending
    std::shared_ptr<const std::vector<bool>> hot_;   // per cell
};

}  // namespace dg
