// light_path.h -- light that is followed from an emitter, from one surface to the next; at each of them some
// goes to the lens (light tracing: Arvo 1986, Backward Ray Tracing; Veach 1997, 10.3). So caustics converge
// that a path from the camera meets by chance.
//
// Each path finds what the camera's find by next-event estimation and by meeting emitters, and no more, and
// not what comes straight to the first surface that the lens sees (path_mis.h):
// light of a delta light begins at the first surface that scatters it, and none of it passes the boundary
// of a volume before.
#pragma once
#include <optional>
#include <vector>

#include "render/light_arrival.h"
#include "render/light_weight.h"
#include "render/path_vertex.h"
#include "render/render.h"
#include "render/volume_walk.h"

namespace dg {

/// Follows light path `index` and appends what is on its way to the lens.
class LightPaths {
  public:
    /// All outlives this.
    LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
               const LightWeight& weight);
    void follow(std::uint64_t index, std::vector<LightArrival>& arrivals, std::uint64_t& rays) const;

  private:
    struct Walk;
    std::optional<Walk> begin(std::uint64_t index) const;
    bool bounce(Walk& walk, std::vector<LightArrival>& arrivals) const;
    void connect(const Walk& walk, PathVertex& both, const SurfaceHit& hit, Vec2f u_lens, Vec2f u_pixel,
                 std::vector<LightArrival>& arrivals) const;
    bool advance(Walk& walk, PathVertex& both, const SurfaceHit& hit, const LightStep& step) const;
    std::optional<Spectrum> enter(const Walk& walk, VolumeWalk& volume, const Bsdf& bsdf,
                                  const SurfaceHit& hit, Vec3f w) const;
    double camera_density(const Walk& walk, const SurfaceHit& hit, float bsdf_pdf) const;

    const Scene& scene_;
    const Camera& camera_;
    const RenderSettings& settings_;
    const LightWeight& weight_;
    bool end_secondary_;
};

}  // namespace dg
