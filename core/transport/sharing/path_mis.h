// path_mis.h -- MIS weights of camera paths with at least two surface vertices, against light paths (light_walk.h).
// Direct light (k = 2) is left to the camera: next-event estimation has less noise there than light tracing.
//
// Path x_0 (lens), x_1, ..., x_k (emitter), k >= 3. With densities p' per projected solid angle all
// geometry terms cancel (Veach 1997, Robust Monte Carlo Methods, 10.2), and
//   light     M p(x_k) p'_emit  p'_back(x_k-1) ... p'_back(x_2)  p'_lens(x_1)
//   ------ = ----------------------------------------------------------------------
//   camera    D  p'(x_1) ... p'(x_k-2)  (p'_bsdf(x_k-1) + p'_light(x_k-1))
// D is the camera's density of the first ray, p' the BSDF density toward the light, and p'_back the BSDF density toward
// the camera of a path that arrives from the light. Delta lobes have a ratio of 1, windows are no vertices, and
// roulette is ignored. BSDFs are evaluated without ray cone footprints, since light paths have none. The ratio is 0
// where light paths end: at x_1 with a delta lobe, at dispersion, at delta lobes with adjusted shading normals, and in
// nested volumes.
#pragma once
#include "scene/scene.h"
#include "transport/sharing/first_ray.h"
#include "transport/sharing/path_vertex.h"
#include "transport/sharing/volume_state.h"

namespace dg {

class PathMis {
  public:
    explicit PathMis(const FirstRay& first) : first_(first), open_(first.sharing().bounces()) {}

    /// Whether light paths may find the continuation of this path.
    bool open() const { return open_; }

    /// A vertex of the camera path.
    class Vertex {
      public:
        /// `hit`: as intersected, before shading. `shaded`: its BSDF. The arguments must outlive the vertex.
        Vertex(const Scene& scene, const Material& material, const SurfaceHit& hit,
               const Wavelengths& wavelengths, const Bsdf& shaded);

      private:
        friend class PathMis;
        PathVertex& bidirectional();   // created on first use
        const Scene& scene_;
        const Material& material_;
        const Wavelengths& wavelengths_;
        const Bsdf& shaded_;
        bool point_;      // the hit has no footprint, so shaded_ serves for both directions
        SurfaceHit hit_;
        std::optional<PathVertex> bidirectional_;
    };

    /// MIS weight of the camera path for a light sample of next-event estimation.
    float weight_of_sample(const Scene& scene, Vertex& vertex, const LightSample& light,
                    const Wavelengths& wavelengths) const;
    /// MIS weight of the camera path for an emitter hit `distance` m after its last vertex `from`. `light_over_bsdf`:
    /// density of next-event estimation over the BSDF density.
    float weight_of_emitter(std::int64_t light, Vec3f from, Vec3f direction, float distance, float time,
                     float light_over_bsdf) const;
    /// Updates the ratio when the path leaves the vertex.
    void leave(Vertex& vertex, const BsdfSample& sample);

  private:
    double back(Vertex& vertex, const Scattering& s) const;
    static bool cross(VolumeState& volume, Vertex& vertex, Vec3f wi);
    const FirstRay& first_;
    bool open_;
    int vertices_ = 0;                // number of vertices that the path has left
    double light_camera_ratio_ = 1;   // the formula's factors so far, beginning with p'_lens(x_1) / D
    VolumeState volume_;
};

}  // namespace dg
