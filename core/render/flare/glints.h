// glints.h -- small lamps in mirrors and glass, and how to come upon them: each lamp's light is spread over a cone
// about the direction to it, wide at first. A path that leaves a mirror at random misses the sun, but not the cone.
#pragma once
#include <vector>

#include "light/emitter_points.h"
#include "math/sampler.h"
#include "scene/scene.h"

namespace dg {

class Glints {
  public:
    /// The strongest of the sources that have a size. Scene and sources outlive this.
    Glints(const Scene& scene, const EmitterPoints& sources);

    bool empty() const { return sources_.empty(); }
    /// Luminance along a ray to the world by way of mirrors, glass and narrow lobes, were each lamp's light spread
    /// over a cone of this half angle (rad): one path's estimate.
    float seen(Ray ray, float half_angle, Wavelengths wavelengths, PathSampler& sampler,
               std::uint64_t& rays) const;

  private:
    Rgb lamp(int source, const Ray& ray, float half_angle, const Wavelengths& wavelengths, PathSampler& sampler,
             std::uint64_t& rays) const;

    const Scene& scene_;
    const EmitterPoints& all_;
    std::vector<int> sources_;
};

}  // namespace dg
