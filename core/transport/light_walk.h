// light_walk.h -- light that is followed from an emitter, from one surface to the next (light tracing: Arvo 1986,
// Backward Ray Tracing; Veach 1997, 10.3). At each of them some of it may be sent on toward a lens.
//
// Each path finds what the camera's find by next-event estimation and by meeting emitters, and no more, and
// not what comes straight to the first surface that the lens sees (path_mis.h):
// light of a delta light begins at the first surface that scatters it, and none of it passes the boundary
// of a volume before. Media dim it, and scatter nothing: that light is the camera paths' alone.
#pragma once
#include <limits>
#include <optional>

#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/path.h"
#include "transport/sharing/light_sharing.h"
#include "transport/sharing/path_vertex.h"
#include "transport/sharing/volume_walk.h"

namespace dg {

/// The surface that a walk has come to. References point into it, so it stays where it is.
class LightVertex {
  public:
    LightVertex(const Scene& scene, const SurfaceHit& hit, const Wavelengths& wavelengths)
        : hit_(hit), material_(scene.material(hit_)), both_(material_, scene.textures(), hit_, wavelengths) {}
    LightVertex(const LightVertex&) = delete;
    LightVertex& operator=(const LightVertex&) = delete;

    const SurfaceHit& hit() const { return hit_; }
    PathVertex& both() { return both_; }

  private:
    SurfaceHit hit_;
    MaterialAt material_;
    PathVertex both_;
};

class LightWalk {
  public:
    /// Random numbers of the start, in [0, 1), the time of the light and its wavelengths.
    struct Start {
        float u_light;
        Vec2f u_place, u_direction;
        float time;
        Wavelengths wavelengths;
    };
    /// Nothing where no light leaves. All outlives this.
    static std::optional<LightWalk> begin(const Scene& scene, const LightSharing& sharing,
                                          const PathSettings& settings, const Start& start,
                                          const PathSampler& sampler);

    /// Random numbers of one vertex; `lens` and `pixel` are for whoever sends light from there.
    struct Random {
        float lobe;
        Vec2f direction, lens, pixel;
    };
    /// Before the way to a vertex.
    Random draw() { return {sampler_.next_1d(), sampler_.next_2d(), sampler_.next_2d(), sampler_.next_2d()}; }

    /// To the next surface. False: the path ends.
    bool meet(std::optional<LightVertex>& vertex);
    /// Whether light can be sent from a vertex to a lens: direct light is left to the camera's paths.
    bool sends(LightVertex& vertex) const;

    /// Light on its way to a lens.
    struct Sent {
        Spectrum radiance{0.f};   // what a camera path would find there, had it the same density
        double density = 0;       // of such light paths; LightSharing
    };
    /// Along w, which was drawn with this density per sr at the vertex.
    std::optional<Sent> send(LightVertex& vertex, Vec3f w, float lens_pdf) const;

    /// Beyond the vertex. False: the path ends.
    bool go_on(LightVertex& vertex, const Random& u);

    const Ray& ray() const { return ray_; }
    const Wavelengths& wavelengths() const { return wavelengths_; }

  private:
    LightWalk(const Scene& scene, const LightSharing& sharing, const PathSettings& settings,
              const EmissionRay& emission, const PathSampler& sampler)
        : scene_(&scene), sharing_(&sharing), settings_(&settings), emission_(emission), sampler_(sampler) {}
    std::optional<Scene::Hit> meet_visible();
    void absorb(float length);
    bool is_last() const { return vertices_ == settings_->max_depth; }   // behind it only windows count
    bool pass(LightVertex& vertex, const LightStep& step);
    bool survives();
    std::optional<Spectrum> enter(VolumeWalk& volume, const Bsdf& bsdf, const SurfaceHit& hit, Vec3f w) const;
    double camera_density(const SurfaceHit& hit, float bsdf_pdf) const;
    float distance() const { return infinite() ? std::numeric_limits<float>::infinity() : straight_; }
    /// Share of its light that a finite range leaves, at the first vertex.
    float reach() const { return vertices_ == 0 ? range_attenuation(light_, straight_) : 1; }
    bool infinite() const {
        return emission_.light == LightSet::kEnvironment || std::holds_alternative<DirectionalLight>(light_);
    }

    const Scene* scene_;
    const LightSharing* sharing_;
    const PathSettings* settings_;
    EmissionRay emission_;
    PathSampler sampler_;
    Light light_{};            // that it left; unused of the environment
    bool delta_ = false;
    Ray ray_{};
    Spectrum flux_{0.f}, start_{0.f};
    double odds_ = 0;          // the ratio of path_mis.h so far, from the light on
    int vertices_ = 0;
    float straight_ = 0;       // m from the last vertex or the light, through windows
    float unknown_ = 0;        // m within whatever the light is in
    VolumeWalk volume_{VolumeWalk::Where::unknown};
    Interior medium_{};        // its participating medium alone
    Wavelengths wavelengths_{};
};

}  // namespace dg
