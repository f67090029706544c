// light_path.h -- light paths with bounces (transport/light_walk.h), and what they send to the lens from each
// surface. So caustics converge that a path from the camera meets by chance.
#pragma once
#include <optional>
#include <vector>

#include "render/light_arrival.h"
#include "render/light_weight.h"
#include "render/render.h"
#include "transport/light_walk.h"

namespace dg {

/// Follows light path `index` and appends what is on its way to the lens.
class LightPaths {
  public:
    /// All outlives this.
    LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
               const LightWeight& weight);
    void follow(std::uint64_t index, std::vector<LightArrival>& arrivals, std::uint64_t& rays) const;

  private:
    struct Flight;
    std::optional<Flight> begin(std::uint64_t index) const;
    std::optional<LightArrival> connect(const Flight& flight, LightVertex& vertex,
                                        const LightWalk::Random& u) const;

    const Scene& scene_;
    const Camera& camera_;
    const RenderSettings& settings_;
    const LightWeight& weight_;
    bool end_secondary_;
};

}  // namespace dg
