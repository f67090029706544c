// light_pass.h -- light tracing from emitters to the film. A path goes directly from a point on an emitter to a point
// of the pupil as seen from there, or over surfaces (light_path.h). The lens is traced for each wavelength to a film
// point, and unoccluded light that passes the lens is splatted.
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

/// Indices of the light paths of the sample indices [begin, end), on average `per_sample` per sample index. Any split
/// of the samples gives the same paths.
IndexRange light_path_range(double begin, double end, double per_sample, std::uint64_t seed);

/// An arrival as the pilot records it: the light that it would add to a single pixel with light paths alone, the ratio
/// of camera density to light density, and RayOnFilm::spread().
struct LoggedSplat {
    Pixel pixel;
    Vec3f xyz;
    double camera_over_light;
    float spread;
    std::uint32_t path;   // its index
};

/// Traces arrivals through the lens to the film; base of both kinds of light paths.
class LightPass {
  public:
    static constexpr std::uint64_t kBlock = 4096;
    struct Workspace {
        std::vector<LightArrival> paths;
        std::vector<CameraRay> rays;
        std::vector<float> nm;
        std::vector<Reprojection> landings;
        RenderCounters counters;
        std::vector<LoggedSplat>* log = nullptr;   // receives arrivals instead of the film, in the pilot
    };

  protected:
    /// `cone`: of camera samples. The arguments must outlive this.
    LightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone);

    /// Calls begin(index) for [first, last), which appends paths to `work`, and traces them.
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
    int landings_;         // landings per path: 1, or one for each wavelength if the lens disperses
};

/// Light paths directly from an emitter to the lens.
class StraightLightPass : public LightPass {
  public:
    StraightLightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone)
        : LightPass(picture, weight, cone) {}
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    std::optional<LightArrival> begin(std::uint64_t index) const;
};

/// Light paths with bounces.
class BouncedLightPass : public LightPass {
  public:
    BouncedLightPass(const Picture& picture, const LightWeight& weight, const PixelCone& cone)
        : LightPass(picture, weight, cone), paths_(picture.scene, picture.camera, picture.settings, weight) {}
    void draw(Workspace& work, std::uint64_t first, std::uint64_t last) const;

  private:
    LightPaths paths_;
};

}  // namespace dg
