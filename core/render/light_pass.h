// light_pass.h -- light that goes from an emitter straight to the lens, followed from the emitter: a point
// on it, a ray toward the lens as it is seen from there, traced to a film point for each wavelength. What
// the lens lets through and nothing is in the way of lands in a pixel.
//
// Sources: Veach 1997 (light tracing as one technique of many); Hanika and Dachsbacher 2014, Efficient Monte
// Carlo Rendering with Realistic Lenses, EGSR; Schrade, Hanika, Dachsbacher 2016, Sparse high-degree
// polynomials for wide-angle lenses, EGSR.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "camera/pixel_cone.h"
#include "render/light_path.h"
#include "render/light_weight.h"
#include "render/ray_on_film.h"
#include "render/render.h"

namespace dg {

/// Indices [0], ..., [1] - 1 of the light paths that belong to sample indices [begin, end), `per_sample` of
/// them to each: any split of the samples gives the same paths, and their mean number is right.
std::array<std::uint64_t, 2> light_path_range(double begin, double end, double per_sample,
                                              std::uint64_t seed);

class LightPass {
  public:
    /// All outlives this.
    LightPass(const Scene& scene, const Camera& camera, Film& film, const RenderSettings& settings,
              const FilmDensity& density, const LightWeight& weight, const PixelCone& cone);

    /// Buffers of one thread.
    struct Workspace;

    /// Draws light paths [first, last) straight to the lens.
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;
    /// Those with bounces (light_path.h).
    void draw_bounced(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    std::optional<LightArrival> begin(std::uint64_t index) const;
    void trace(Workspace& work) const;
    void look(LightArrival& path, std::span<const Reprojection> landings) const;
    void finish(Workspace& work, const LightArrival& path, std::span<const Reprojection> landings) const;

    const Scene& scene_;
    const Camera& camera_;
    Film& film_;
    const RenderSettings& settings_;
    const FilmDensity& density_;
    const LightWeight& weight_;
    const PixelCone& cone_;   // of camera samples
    LightPaths bounced_;
    int landings_;         // per path: one for each wavelength that has a way of its own
    bool end_secondary_;
};

/// Light that light paths alone would add by one arrival, were it to one pixel; how much more densely camera samples
/// draw the same; and RayOnFilm::spread().
struct LoggedSplat {
    Pixel pixel;
    Vec3f xyz;
    double camera_over_light;
    float spread;
    std::uint32_t path;   // its index
};

struct LightPass::Workspace {
    std::vector<LightArrival> paths;
    std::vector<CameraRay> rays;
    std::vector<float> nm;
    std::vector<Reprojection> landings;
    RenderCounters counters;
    std::vector<LoggedSplat>* log = nullptr;   // of a pilot, instead of the film
};

}  // namespace dg
