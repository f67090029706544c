// glints.h -- finds reflections of small lamps in mirrors and glass. Each lamp's light is spread over a cone around its
// direction, which paths after a specular bounce are likely to hit.
#pragma once
#include <vector>

#include "light/emitter_points.h"
#include "math/sampler.h"
#include "scene/scene.h"

namespace dg {

class Glints {
  public:
    /// Uses the strongest sources that have an area. Scene and sources must outlive this.
    Glints(const Scene& scene, const EmitterPoints& sources);

    bool empty() const { return sources_.empty(); }
    /// One-path estimate of the luminance along a world ray through mirrors, glass and narrow lobes, with each lamp's
    /// light spread over a cone of this half angle (rad).
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
