// light_path.h -- light paths with bounces (transport/light_walk.h), connected to the lens at each surface. They make
// caustics converge that camera paths hit only by chance.
#pragma once
#include <optional>
#include <vector>

#include "render/light_arrival.h"
#include "render/light_weight.h"
#include "render/render.h"
#include "transport/light_walk.h"

namespace dg {

/// Traces light path `index` and appends its connections to the lens.
class LightPaths {
  public:
    /// The arguments must outlive this.
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
