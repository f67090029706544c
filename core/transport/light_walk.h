// light_walk.h -- a random walk from an emitter over the surfaces of the scene (light tracing: Arvo 1986, Backward Ray
// Tracing; Veach 1997, 10.3). Each vertex may be connected to the lens.
//
// Light walks cover a subset of the light that camera paths find by next-event estimation and by hitting emitters. The
// camera alone computes direct light on the first surface that the lens sees (path_mis.h), and light scattered by
// media: media attenuate a light walk and do not scatter it. The light of a delta light must be scattered by a surface
// before it crosses the boundary of a volume.
#pragma once
#include <limits>
#include <optional>

#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/path.h"
#include "transport/sharing/light_sharing.h"
#include "transport/sharing/path_vertex.h"
#include "transport/sharing/volume_state.h"

namespace dg {

/// A surface vertex of a light walk. It cannot be copied, since its members refer to each other.
class LightVertex {
  public:
    LightVertex(const Scene& scene, const SurfaceHit& hit, const Wavelengths& wavelengths)
        : hit_(hit), material_(scene.material(hit_)), bidirectional_(material_, scene.textures(), hit_, wavelengths) {}
    LightVertex(const LightVertex&) = delete;
    LightVertex& operator=(const LightVertex&) = delete;

    const SurfaceHit& hit() const { return hit_; }
    PathVertex& bidirectional() { return bidirectional_; }

  private:
    SurfaceHit hit_;
    MaterialAt material_;
    PathVertex bidirectional_;
};

class LightWalk {
  public:
    /// Random numbers of the start, in [0, 1), the time of emission and the wavelengths.
    struct Start {
        float u_light;
        Vec2f u_place, u_direction;
        float time;
        Wavelengths wavelengths;
    };
    /// Empty if the sampled ray carries no light. The arguments must outlive the walk.
    static std::optional<LightWalk> begin(const Scene& scene, const LightSharing& sharing,
                                          const PathSettings& settings, const Start& start,
                                          const PathSampler& sampler);

    /// Random numbers of one vertex; `lens` and `pixel` are for its connection to the lens.
    struct Random {
        float lobe;
        Vec2f direction, lens, pixel;
    };
    /// Draws the random numbers of the next vertex; call it before meet().
    Random draw() { return {sampler_.next_1d(), sampler_.next_2d(), sampler_.next_2d(), sampler_.next_2d()}; }

    /// Traces to the next surface. False: the walk ends.
    bool meet(std::optional<LightVertex>& vertex);
    /// Whether the vertex can be connected to the lens. Direct light is left to camera paths.
    bool sends(LightVertex& vertex) const;

    /// A connection to the lens.
    struct Sent {
        Spectrum radiance{0.f};   // radiance estimate of a camera path with the same density
        double density = 0;       // of light paths, in the measure of LightSharing
    };
    /// Connects along w, a direction that was drawn at the vertex with the density `lens_pdf`, 1/sr.
    std::optional<Sent> send(LightVertex& vertex, Vec3f w, float lens_pdf) const;

    /// Scatters at the vertex. False: the walk ends.
    bool go_on(LightVertex& vertex, const Random& u);

    const Ray& ray() const { return ray_; }
    const Wavelengths& wavelengths() const { return wavelengths_; }

  private:
    LightWalk(const Scene& scene, const LightSharing& sharing, const PathSettings& settings,
              const EmissionRay& emission, const PathSampler& sampler)
        : scene_(&scene), sharing_(&sharing), settings_(&settings), emission_(emission), sampler_(sampler) {}
    std::optional<Scene::Hit> meet_visible();
    bool meets_solids(SurfaceHit hit) const;
    void absorb(float length);
    bool is_last() const { return vertices_ == settings_->max_depth; }   // only windows may follow
    bool pass(LightVertex& vertex, const LightStep& step);
    bool survives();
    std::optional<Spectrum> enter(VolumeState& volume, const Bsdf& bsdf, const SurfaceHit& hit, Vec3f w) const;
    double camera_density(const SurfaceHit& hit, float bsdf_pdf) const;
    float distance() const { return infinite() ? std::numeric_limits<float>::infinity() : distance_; }
    /// Attenuation by the finite range of a punctual light, applied at the first vertex.
    float reach() const { return vertices_ == 0 ? range_attenuation(light_, distance_) : 1; }
    bool infinite() const {
        return emission_.light == LightSet::kEnvironment || std::holds_alternative<DirectionalLight>(light_);
    }

    const Scene* scene_;
    const LightSharing* sharing_;
    const PathSettings* settings_;
    EmissionRay emission_;
    PathSampler sampler_;
    Light light_{};            // the emitter; not used for the environment
    bool delta_ = false;
    Ray ray_{};
    Spectrum flux_{0.f}, start_{0.f};
    double light_camera_ratio_ = 0;   // density ratio of path_mis.h, accumulated from the light
    int vertices_ = 0;
    float distance_ = 0;       // m from the last vertex or the light, through windows
    float unknown_ = 0;        // m through the volume around the emitter, as long as that volume is unknown
    VolumeState volume_{VolumeState::Where::unknown};
    Interior medium_{};        // only its participating medium is used
    Wavelengths wavelengths_{};
};

}  // namespace dg
