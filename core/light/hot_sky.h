// hot_sky.h -- the bright spots of an environment's picture that a lens sees: sun, street lamps, windows.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/environment.h"
#include "light/view_cone.h"
#include "math/distribution.h"

namespace dg {

/// Those cells of the picture (environment.cpp) that may be seen from a view and are much brighter than the
/// mean of what is seen; sampled by luminance, as the whole would be. What is even is left out: paths from
/// the lens find it wherever they look.
class HotSky {
  public:
    HotSky() = default;
    HotSky(const Environment& environment, std::span<const ViewCone> views);

    /// Illuminance by all spots together (lux), on a surface that faces them.
    double illuminance() const { return cells_.empty() ? 0 : strength_ * cells_.sum(); }
    /// World directions and densities (per sr) at a time; pdf is 0 outside the spots.
    Environment::Sample sample(Vec2f u, float time) const;
    float pdf(Vec3f direction, float time) const;
    bool empty() const { return cells_.empty(); }

    /// The spots by the part of the sky where they are, 22.5 degrees across; of all parts but the brightest,
    /// at most `most`, the rest together. Samples and densities of a part are its own.
    std::vector<HotSky> parts(int most) const;

  private:
    void mark_hot();

    Environment environment_;
    double strength_ = 1;               // of the environment at most
    DiscreteDistribution cells_;
    std::vector<std::uint32_t> index_;  // of the cells, rows of the picture; rising
    std::shared_ptr<const std::vector<bool>> hot_;   // by cell
};

}  // namespace dg
