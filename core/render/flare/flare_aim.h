// flare_aim.h -- a flare path without what it is drawn by: from a point of an emitter to a place on the front of
// the lens, and from there by one ghost to the film. All of it is exact.
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
    Spectrum radiance{0.f};   // or what stands for it of lights without size
    double density = 0;       // of such paths, per m2 sr
    Vec2f at{};               // where it was aimed at, [-1, 1)^2
    EmitterPoint from{};
};

/// From where it comes to where rays of the lens start; world.
Ray flare_shadow(const EmitterPoint& from, const Ray& from_lens);

/// Light from the world along the way of a path, as its wavelengths may reach the film each in its place.
/// `sampler`: for paths through the scene, which light that other things reflect needs; `rays` counts them all.
Spectrum flare_light(const Scene& scene, const Camera& camera, const PathSettings& settings,
                     const FlareArrival& path, PathSampler sampler, std::uint64_t& rays);

class FlareAim {
  public:
    /// An exact lens; it and the scene outlive this. Of the settings: sensor, shutter, reach of the filter, and
    /// for highlights how paths go on in the scene.
    FlareAim(const Scene& scene, const Camera& camera, const RenderSettings& settings);

    bool is_of(const Scene& scene, const Camera& camera) const {
        return &scene == &scene_ && &camera == &camera_;
    }
    const Scene& scene() const { return scene_; }
    const Camera& camera() const { return camera_; }
    int ghosts() const { return int(mirrors_.size()); }
    /// Those by two reflections: the first of them.
    int pairs() const { return pairs_; }
    const Mirrors& mirrors(int ghost) const { return mirrors_[ghost]; }
    /// The lens as it is at first, and a ghost's way through it.
    const GhostLens& ghost_lens() const { return states_.front().ghosts; }
    const std::vector<GhostStep>& steps(int ghost) const { return states_.front().steps[ghost]; }
    const EmitterPoints& sources() const { return sources_; }
    /// Bright spots among what other things send to the lens, and how many rays it took to find them.
    int spots() const { return spots_; }
    std::uint64_t survey_rays() const { return survey_rays_; }
    double front_radius() const { return radius_; }   // m
    const Sensor& sensor() const { return sensor_; }
    const Shutter& shutter() const { return shutter_; }
    /// Reflectance of a ghost's mirrors together, straight on.
    double reflectance(int ghost) const;
    /// Share of some rays from a source to the front that are free; never 0, as few are looked at.
    double visible_share(int source) const;

    /// From random numbers by purpose.
    struct Random {
        float select;
        FlareLambda lambda;
        Vec2f point;
        Moment moment;
    };
    /// Toward a place of the square that holds the front as it is seen from the point, [-1, 1)^2; `pdf`: of
    /// source, ghost and place, per unit of the square. Nothing if the path cannot bring light.
    std::optional<FlareArrival> aim(int source, int ghost, Vec2f at, double pdf, const Random& u) const;

    /// A point of a source as the lens has it: camera frame, m; a unit direction where it is at infinity.
    struct SourcePoint {
        Vec3d place;
        bool at_infinity;
        Rgb light;   // that it brings to a unit of the square's middle, with the chance by which it was drawn taken out
        EmitterPoint from;
    };
    std::optional<SourcePoint> point(int source, float select, Vec2f u, float time) const;

    /// Which of the lens's states is in place at a time.
    std::size_t state_at(float time) const;
    /// All by one ghost through one state.
    void trace(std::size_t state, int ghost, std::span<const CameraRay> rays, std::span<const float> nm,
               std::span<Reprojection> out) const;

    /// Where on the frame a landing is, px; nothing outside of the filter's reach.
    std::optional<Vec2f> on_frame(const Reprojection& landing, float time) const;
    /// Tells RayOnFilm which of a path's landings arrive; how many do.
    int mark_arrived(std::span<Reprojection> landings, float time) const;

  private:
    struct State {
        ExactLens lens;
        GhostLens ghosts;
        std::vector<std::vector<GhostStep>> steps;
    };

    /// From a place of the front toward where light comes from.
    struct Way {
        Affine3d pose;
        Vec3d start, direction;   // camera frame, m
        Vec3f world;              // direction
        float time;
        double spread;            // times densities of the point and of m2 of the square: per m2 sr of rays
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
    std::vector<float> times_;     // of the states; empty: one
    std::vector<State> states_;
    std::vector<Mirrors> mirrors_;
    int pairs_ = 0;
    Vec3d center_{};               // camera frame, m: of the front
    double radius_ = 0;
    int spots_ = 0;
    std::uint64_t survey_rays_ = 0;
    EmitterPoints sources_;
};

}  // namespace dg
