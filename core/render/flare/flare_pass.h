// flare_pass.h -- ghosts by light tracing: a point on an emitter, a ghost, and a ray to the front lens, traced exactly
// through the ghost's surfaces to a film point for each wavelength. Unoccluded light that passes the lens is splatted.
//
// Light reflected by the scene is estimated by paths (path.h) that start with the ray that leaves the lens.
//
// Units and weights are as in light_pass.h. No other technique finds ghosts, so no MIS is needed.
#pragma once
#include <vector>

#include "render/flare/flare_guide.h"
#include "render/pass.h"

namespace dg {

class FlarePass {
  public:
    static constexpr std::uint64_t kBlock = 16384;   // enough paths per ghost to fill the SIMD lanes
    /// `per_sample`: paths per unit of the density's counts.
    FlarePass(const Picture& picture, double per_sample, std::shared_ptr<const FlareGuide> guide);

    /// Buffers of a thread.
    struct Workspace {
        std::vector<FlareArrival> paths;
        std::vector<Vec2f> u_pixel;
        std::vector<PathSampler> samplers;   // for paths through the scene
        std::vector<std::uint32_t> sample, order;
        std::vector<CameraRay> rays;
        std::vector<float> nm;
        std::vector<Reprojection> landings;
        RenderCounters counters;
    };

    /// Draws flare paths [first, last).
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    void begin(Workspace& work, std::uint64_t index) const;
    void trace(Workspace& work, std::size_t first, std::size_t last) const;
    void prefetch(const Workspace& work, std::size_t path) const;
    void finish(Workspace& work, std::size_t path, std::span<const Reprojection> landings) const;

    Picture picture_;
    double per_sample_, scale_;
    std::shared_ptr<const FlareGuide> guide_;
};

}  // namespace dg
