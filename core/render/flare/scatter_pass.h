// scatter_pass.h -- light scattered inside the lens, by light tracing: a point on an emitter, a ray to the front lens,
// and a random walk through the lens (optics/stray/scatter_lens.h), scattered by barrel, blades or rough surfaces.
// Unoccluded light that reaches the film is splatted to nodes (scatter_nodes.h) or, where it is not smooth, to pixels,
// in the flare layer.
//
// Units and weights are as in light_pass.h. No other technique finds this light.
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
    std::unique_ptr<const ScatterNodes> nodes_;   // null: splats to pixels only
};

}  // namespace dg
