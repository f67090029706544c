// flare_pass.h -- ghosts, drawn from the emitters: a point that shines, a ghost, a ray to the front lens, traced
// exactly by two reflections to a film point for each wavelength. What the lens lets through and nothing is in
// the way of lands in a pixel.
//
// Light that other things send to the lens comes along paths of path.h, which begin where the lens's ray leaves.
//
// Units and weights are those of light_pass.h; no other technique finds ghosts, so there is nothing to share.
#pragma once
#include <vector>

#include "render/flare/flare_guide.h"
#include "render/pass.h"

namespace dg {

class FlarePass {
  public:
    static constexpr std::uint64_t kBlock = 16384;   // enough of one ghost to fill the SIMD lanes
    /// `per_sample`: paths per unit of the density's counts.
    FlarePass(const Picture& picture, double per_sample, std::shared_ptr<const FlareGuide> guide);

    /// Buffers of one thread.
    struct Workspace {
        std::vector<FlareArrival> paths;
        std::vector<Vec2f> u_pixel;
        std::vector<PathSampler> samplers;   // for what follows in the world
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
