// scatter_pass.h -- light that the lens's own parts scatter, drawn from the emitters: a point that shines, a ray
// to the front lens, and a walk through it (optics/stray/scatter_lens.h) that barrel, blades or a rough surface turn.
// What comes to the film and nothing is in the way of lands on the nodes around it (scatter_nodes.h) or, where light is not
// smooth, in a pixel, in the layer of flare.
//
// Units and weights are those of light_pass.h; no other technique finds this light.
#pragma once
#include "render/flare/scatter_nodes.h"

namespace dg {

class ScatterPass {
  public:
    static constexpr std::uint64_t kBlock = 2048;
    struct Workspace {
        ScatterNodes::Work arrivals;
        RenderCounters counters;
    };

    /// `per_sample`: paths per unit of the density's counts.
    ScatterPass(const Picture& picture, double per_sample, std::shared_ptr<const ScatterGuide> guide);

    /// Draws paths [first, last).
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;
    void finish(int threads) const {
        if (nodes_) nodes_->finish(threads);
    }

  private:
    void draw_one(Workspace& work, std::uint64_t index) const;

    Picture picture_;
    double per_sample_, scale_;
    std::shared_ptr<const ScatterGuide> guide_;
    std::unique_ptr<const ScatterNodes> nodes_;   // null: pixels alone
};

}  // namespace dg
