// light_pass.h -- light that goes from an emitter to the lens, followed from the emitter: straight, a point
// on it and a ray toward the lens as it is seen from there, or over surfaces (light_path.h); traced to a film
// point for each wavelength. What the lens lets through and nothing is in the way of lands in a pixel.
//
// Sources: Veach 1997 (light tracing as one technique of many); Hanika and Dachsbacher 2014, Efficient Monte
// Carlo Rendering with Realistic Lenses, EGSR; Schrade, Hanika, Dachsbacher 2016, Sparse high-degree
// polynomials for wide-angle lenses, EGSR.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "camera/inverse/pixel_cone.h"
#include "render/light_path.h"
#include "render/light_weight.h"
#include "render/pass.h"
#include "render/ray_on_film.h"

namespace dg {

/// Indices of the light paths that belong to sample indices [begin, end), `per_sample` of
/// them to each: any split of the samples gives the same paths, and their mean number is right.
IndexRange light_path_range(double begin, double end, double per_sample, std::uint64_t seed);

/// Light that light paths alone would add by one arrival, were it to one pixel; how much more densely camera samples
/// draw the same; and RayOnFilm::spread().
struct LoggedSplat {
    Pixel pixel;
    Vec3f xyz;
    double camera_over_light;
    float spread;
    std::uint32_t path;   // its index
};

/// Way from the lens to the film, shared by both kinds.
class LightPass {
  public:
    static constexpr std::uint64_t kBlock = 4096;
    struct Workspace {
        std::vector<LightArrival> paths;
        std::vector<CameraRay> rays;
        std::vector<float> nm;
        std::vector<Reprojection> landings;
        RenderCounters counters;
        std::vector<LoggedSplat>* log = nullptr;   // of a pilot, instead of the film
    };

  protected:
    /// `cone`: of camera samples. All outlives this.
    LightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone);

    /// Calls begin(index) for [first, last), which appends to the paths of `work`, and traces them.
    template <typename Begin>
    void draw_each(Workspace& work, std::uint64_t first, std::uint64_t last, const Begin& begin) const {
        for (std::uint64_t i = first; i < last; ++i) {
            begin(i);
            if (work.paths.size() >= kBatchSize) trace(work);
        }
        trace(work);
        work.counters.light_paths += last - first;
    }

    Picture picture_;
    const LightWeight& weight_;
    bool end_secondary_;

  private:
    static constexpr int kBatchSize = 256;   // paths per call of the lens: their wavelengths fill the SIMD lanes
    void trace(Workspace& work) const;
    void look(LightArrival& path, std::span<const Reprojection> landings) const;
    void finish(Workspace& work, const LightArrival& path, std::span<const Reprojection> landings) const;

    const PixelCone& cone_;
    int landings_;         // per path: one for each wavelength that has a way of its own
};

/// Straight from an emitter to the lens.
class StraightLightPass : public LightPass {
  public:
    StraightLightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone)
        : LightPass(picture, weight, cone) {}
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    std::optional<LightArrival> begin(std::uint64_t index) const;
};

/// With bounces.
class BouncedLightPass : public LightPass {
  public:
    BouncedLightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone)
        : LightPass(picture, weight, cone), paths_(picture.scene, picture.camera, picture.settings, weight) {}
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    LightPaths paths_;
};

}  // namespace dg
