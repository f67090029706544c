// flare_aim.h -- exact flare paths: from a point on an emitter to a point on the front of the lens, and through a
// ghost's surfaces to the film. The densities that choose source, ghost and front point are the caller's.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "light/emitter_points.h"
#include "render/flare/flare_lambda.h"
#include "render/render.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// A path from an emitter into the lens.
struct FlareArrival {
    CameraRay lens;           // camera frame; on the first surface
    int ghost = 0;
    Wavelengths wavelengths;
    Spectrum radiance{0.f};   // or the equivalent for delta lights
    double density = 0;       // of the path, per m2 sr
    Vec2f at{};               // target on the front, [-1, 1)^2
    EmitterPoint from{};
};

/// Shadow ray from the emitter to the origin of the lens's ray; world.
Ray flare_shadow(const EmitterPoint& from, const Ray& from_lens);

/// Transmittance along the ray of flare_shadow(), which starts in the solids and media around the camera.
Spectrum flare_transmittance(const Scene& scene, const PathSettings& settings, const EmitterPoint& from,
                             const Ray& shadow, const Wavelengths& wavelengths);

/// Radiance of the scene along a flare path, for wavelengths that reach separate film points. `sampler`: for the path
/// tracer, which reflected light needs. `rays`: counter of all rays.
Spectrum flare_light(const Scene& scene, const Camera& camera, const PathSettings& settings,
                     const FlareArrival& path, PathSampler sampler, std::uint64_t& rays);

class FlareAim {
  public:
    /// `camera` has an exact lens; it and the scene must outlive this. Uses sensor, shutter and filter radius of the
    /// settings, and for highlights the path settings.
    FlareAim(const Scene& scene, const Camera& camera, const RenderSettings& settings);

    bool is_of(const Scene& scene, const Camera& camera) const {
        return &scene == &scene_ && &camera == &camera_;
    }
    const Scene& scene() const { return scene_; }
    const Camera& camera() const { return camera_; }
    int ghosts() const { return int(mirrors_.size()); }
    /// Number of ghosts with two reflections; they come first.
    int pairs() const { return pairs_; }
    const Mirrors& mirrors(int ghost) const { return mirrors_[ghost]; }
    /// Ghosts of the lens in its first state.
    const GhostLens& ghost_lens() const { return states_.front().ghosts; }
    const std::vector<GhostStep>& steps(int ghost) const { return states_.front().steps[ghost]; }
    const EmitterPoints& sources() const { return sources_; }
    /// Number of bright spots among reflections in the scene, and the number of rays that the survey took.
    int spots() const { return spots_; }
    std::uint64_t survey_rays() const { return survey_rays_; }
    double front_radius() const { return radius_; }   // m
    const Sensor& sensor() const { return sensor_; }
    const Shutter& shutter() const { return shutter_; }
    /// Product of the reflectances of a ghost's mirrors at normal incidence.
    double reflectance(int ghost) const;
    /// Estimated unoccluded fraction of rays from a source to the front; never 0, as it comes from few rays.
    double visible_share(int source) const;

    /// Random numbers of a path.
    struct Random {
        float select;
        FlareLambda lambda;
        Vec2f point;
        Moment moment;
    };
    /// Aims at a point `at` of the square [-1, 1)^2 that bounds the front as seen from the emitter point. `pdf`:
    /// density of source, ghost and `at`, per unit of the square. Empty if the path carries no light.
    std::optional<FlareArrival> aim(int source, int ghost, Vec2f at, double pdf, const Random& u) const;

    /// A point of a source in the camera frame, m; a unit direction for sources at infinity.
    struct SourcePoint {
        Vec3d place;
        bool at_infinity;
        Rgb light;   // illuminance at the center of the square, divided by the density of the point
        EmitterPoint from;
    };
    std::optional<SourcePoint> point(int source, float select, Vec2f u, float time) const;

    /// Index of the lens state at a time.
    std::size_t state_at(float time) const;
    /// Traces rays through a ghost of a lens state.
    void trace(std::size_t state, int ghost, std::span<const CameraRay> rays, std::span<const float> nm,
               std::span<Reprojection> out) const;

    /// Film position of a landing, px; empty beyond the filter radius around the frame.
    std::optional<Vec2f> on_frame(const Reprojection& landing, float time) const;
    /// Marks the landings that reach the frame, for RayOnFilm; returns their number.
    int mark_arrived(std::span<Reprojection> landings, float time) const;

  private:
    struct State {
        ExactLens lens;
        GhostLens ghosts;
        std::vector<std::vector<GhostStep>> steps;
    };

    /// Ray from a point of the front toward the source.
    struct Way {
        Affine3d pose;
        Vec3d start, direction;   // camera frame, m
        Vec3f world;              // direction in the world
        float time;
        double spread;            // converts densities of source point and square (1/m2) to 1/(m2 sr) of rays
        Ray ray() const {
            return {.origin = to_float(pose.point(start)), .direction = world, .time = time};
        }
    };

    void add_state(const Camera& camera, const ExactLens& lens);
    std::vector<ViewCone> views() const;
    void look_for_highlights(const RenderSettings& settings);
    std::optional<Way> way(const EmitterPoint& from, Vec2f at, float time) const;
    Rgb value_of(const EmitterPoint& from, const Way& way) const;

    const Scene& scene_;
    const Camera& camera_;
    Sensor sensor_;
    Shutter shutter_;
    float reach_;                  // px
    std::vector<float> times_;     // of the states; empty: a single state
    std::vector<State> states_;
    std::vector<Mirrors> mirrors_;
    int pairs_ = 0;
    Vec3d center_{};               // of the front; camera frame, m
    double radius_ = 0;
    int spots_ = 0;
    std::uint64_t survey_rays_ = 0;
    EmitterPoints sources_;
};

}  // namespace dg
