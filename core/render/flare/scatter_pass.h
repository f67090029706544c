// scatter_pass.h -- light that the lens's own parts scatter, drawn from the emitters: a point that shines, a ray
// to the front lens, and a walk through it (optics/stray/scatter_lens.h) that barrel, blades or a rough surface turn.
// What comes to the film and nothing is in the way of lands in a pixel, in the layer of flare.
//
// Units and weights are those of light_pass.h; no other technique finds this light.
#pragma once
#include "render/flare/scatter_guide.h"
#include "render/ray_on_film.h"

namespace dg {

class ScatterPass {
  public:
    /// `per_sample`: paths per unit of the density's counts. All outlives this.
    ScatterPass(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& settings,
                const FilmDensity& density, double per_sample, const ScatterGuide& guide);

    /// Draws paths [first, last).
    void draw(RenderCounters& counters, std::uint64_t first, std::uint64_t last) const;

  private:
    void draw_one(RenderCounters& counters, std::uint64_t index) const;

    const Scene& scene_;
    const Camera& camera_;
    Film& film_;
    const RenderSettings& settings_;
    const FilmDensity& density_;
    const ScatterGuide& guide_;
    double per_sample_, scale_;
};

}  // namespace dg
