// path_mis.h -- what is left to a path from the camera of the light that it finds after a bounce or
// more, where light paths find it too (light_walk.h). Direct light (k = 2) is the camera's own: next-event
// estimation has less noise there than light that lands by chance.
//
// Path x_0 (lens), x_1, ..., x_k (emitter), k >= 3. With densities p' per projected solid angle all
// geometry terms cancel (Veach 1997, Robust Monte Carlo Methods, 10.2), and
//   light     M p(x_k) p'_emit  p'_back(x_k-1) ... p'_back(x_2)  p'_lens(x_1)
//   ------ = ----------------------------------------------------------------------
//   camera    D  p'(x_1) ... p'(x_k-2)  (p'_bsdf(x_k-1) + p'_light(x_k-1))
// D: the camera's density of the first ray, p' the BSDF's density toward the light, p'_back that toward the
// camera for a path that comes from the light. Delta lobes have the ratio 1 on both sides, windows are no
// vertices, and roulette is left out. BSDFs are those of a point here, without the footprints of cones, as
// light paths have none. Where a light path ends the ratio is 0: at x_1 if it only has a delta lobe, where
// wavelengths part, at normals that a delta lobe sees bent, and in volumes within volumes.
#pragma once
#include "scene/scene.h"
#include "transport/sharing/first_ray.h"
#include "transport/sharing/path_vertex.h"
#include "transport/sharing/volume_walk.h"

namespace dg {

class PathMis {
  public:
    explicit PathMis(const FirstRay& first) : first_(first), open_(first.sharing().bounces()) {}

    /// Light paths may find what the path finds from here on.
    bool open() const { return open_; }

    /// A vertex that the path has come to.
    class Vertex {
      public:
        /// `hit` as found; `shaded`: its BSDF. All outlives this.
        Vertex(const Scene& scene, const Material& material, const SurfaceHit& hit,
               const Wavelengths& wavelengths, const Bsdf& shaded);

      private:
        friend class PathMis;
        PathVertex& both();   // made where it is asked for
        const Scene& scene_;
        const Material& material_;
        const Wavelengths& wavelengths_;
        const Bsdf& shaded_;
        bool point_;      // no footprint: the BSDF is that of a point
        SurfaceHit hit_;
        std::optional<PathVertex> both_;
    };

    /// Share of light that next-event estimation finds; `visible` by its shadow ray.
    float of_sample(const Scene& scene, Vertex& vertex, const LightSample& light,
                    const Wavelengths& wavelengths) const;
    /// Share of an emitter that the path meets `distance` m after its last vertex `from`. Next-event estimation has
    /// its density times `light_over_bsdf`.
    float of_emitter(std::int64_t light, Vec3f from, Vec3f direction, float distance, float time,
                     float light_over_bsdf) const;
    /// Goes on from the vertex.
    void leave(Vertex& vertex, const BsdfSample& sample);

  private:
    double back(Vertex& vertex, const Scattering& s) const;
    static bool cross(VolumeWalk& volume, Vertex& vertex, Vec3f wi);
    const FirstRay& first_;
    bool open_;
    int vertices_ = 0;         // that have been left
    double odds_ = 1;          // the formula so far, from p'_lens(x_1) / D on
    VolumeWalk volume_;
};

}  // namespace dg
