// two_worlds.h -- a path in a scene with catchers, for compositing over a photograph.
//
// Catchers model the set: things that the photograph shows already. The photograph then gets what objects change of the
// set's light: the light of the scene with objects minus its light without (differential rendering; Debevec 1998,
// Rendering Synthetic Objects into Real Scenes, SIGGRAPH). So there are two worlds: the full scene, and the set alone.
// One path serves both as long as they agree. Where it meets an object, or where an object shadows a light, they part:
// the full world goes on there, the set's world passes through the object. Both draw the same random numbers, so that
// noise of the light that objects do not change cancels in the difference.
//
// Effects of a catcher (CatcherEffects) choose which differences count, at the first catcher that the camera sees: the
// factor `kept` of a difference is 1 where its effect is on, and else 0.
//
// A plate is the photograph itself, as objects see it in mirrors and by bounced light: where a path from an object
// comes to a catcher, the photograph gives its light. From there on only differences between the worlds are added.
#pragma once
#include <cstdint>
#include <utility>

#include "material/bsdf_sample.h"
#include "material/material.h"
#include "transport/walk/direct_light.h"
#include "transport/walk/path_state.h"

namespace dg {

/// The worlds in which a path goes on.
enum class World : std::uint8_t { both, full, set };

class TwoWorlds {
  public:
    /// Where the path is, seen from the first catcher on its way.
    enum class FirstCatcher : std::uint8_t { ahead, here, left, behind };
    /// A camera ray that met an object and looks past it: through a clear sheet, or in the set's world.
    enum class PastObject : std::uint8_t { no, through_sheet, in_set };

    /// Saved where a path branches.
    struct State {
        World world = World::full;
        bool for_set = false;         // light found now belongs to the set; false: to the look of an object
        bool through_glass = false;   // the path passed smooth glass
        bool plate_shown = false;     // the plate gave the light of a catcher: only differences count
        PastObject past_object = PastObject::no;
        FirstCatcher first_catcher = FirstCatcher::ahead;
        const CatcherEffects* effects = nullptr;   // of the first catcher, once it is met
        float kept = 1;               // share of differences between the worlds that counts
        float plate_share = 1;        // product of `kept` at the plates on the way
    };
    State state;

    explicit TwoWorlds(const Scene& scene) {
        if (scene.has_catchers()) state.world = World::both, state.for_set = true;
    }

    bool finds_first_hit() const { return state.world != World::set; }

    void gather(PathState& path, Spectrum light, bool hero) const { gather(path, light, hero, state.kept); }
    /// Adds emission that the path met.
    void gather_emission(PathState& path, Spectrum light) const;
    /// Adds a light sample. `visibility(of_set)`: of the light, in the set alone or in the full scene;
    /// `reflected(visible)`: what the path gets from the light then.
    template <Scatters B, typename Visibility, typename Reflected>
    void gather_direct(PathState& path, const B& bsdf, Vec3f wo, const DirectLight& direct,
                       const Visibility& visibility, const Reflected& reflected);

    /// The path goes on from a hit. At an object the worlds part. False: the path ends.
    template <typename Path>
    bool arrive(Path& path, Scene::Hit& found, int vertex, bool counts);
    /// False: the path does not get the light of the background.
    bool sees_background(PathState& path);
    /// Adds the background from the plate; false: the plate does not show it.
    bool show_plate_sky(PathState& path) const;
    void meet_sphere(PathState& path, std::uint32_t sphere);
    /// False: the path ends.
    bool meet_surface(PathState& path, const SurfaceHit& hit);
    /// Adds the light of a catcher from the plate.
    void show_plate(PathState& path, const Material& material, const SurfaceHit& hit);

    /// The path leaves a vertex or a window.
    template <Scatters B>
    void leave(const PathState& path, const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample);
    /// It went on: the surface covers no more than the light that did not pass straight through.
    void uncover(PathState& path, const SurfaceHit& hit) const {
        if (!path.scene.catcher(hit.instance)) cover(path, hit.instance, -1);
    }

  private:
    bool at_first_catcher() const { return state.first_catcher == FirstCatcher::here; }
    bool parts_at(const PathState& path, const Scene::Hit& found) const;
    bool look_through(PathState& path);
    void cover(PathState& path, std::uint32_t object, float sign) const;
    void gather(PathState& path, Spectrum light, bool hero, float kept) const;
    bool plate_is_seen(const PathState& path) const;
    template <Scatters B>
    float kept_by(const B& bsdf, Vec3f wo, Vec3f wi) const;

    float seen_through_ = 0;   // share of the camera ray that passes objects by way of smooth glass; never restored:
                               // the full world adds to it before the set's world reads it
};

template <typename Path>
bool TwoWorlds::arrive(Path& path, Scene::Hit& found, int vertex, bool counts) {
    if (!parts_at(path, found)) return path.arrive(found, vertex, counts);
    const bool from_camera = path.walk.open;
    path.aside(0, [&] {
        state.world = World::full;
        if (from_camera) state.for_set = false;
        if (state.kept > 0 && path.arrive(found, vertex, counts)) path.follow_to_end(vertex);
    });
    // Past an earlier object, the way around that one brings the set's world.
    if (from_camera && state.past_object == PastObject::through_sheet) return false;
    state.world = World::set;
    if (from_camera) state.past_object = PastObject::in_set;
    path.walk.ray.of_set = true;
    return path.step(vertex);
}

template <Scatters B, typename Visibility, typename Reflected>
void TwoWorlds::gather_direct(PathState& path, const B& bsdf, Vec3f wo, const DirectLight& direct,
                              const Visibility& visibility, const Reflected& reflected) {
    const bool of_object = state.world != World::full && path.scene.is_of_object(direct.light.light);
    if (of_object && state.world == World::set) return;
    const auto add = [&](Spectrum visible, World world, float kept) {
        if (visible.is_black()) return;
        const World here = std::exchange(state.world, world);
        gather(path, reflected(visible), direct.f.hero_only || path.walk.hero_only, kept);
        state.world = here;
    };
    const Spectrum now = visibility(state.world == World::set);
    if (state.world != World::both) return add(now, state.world, state.kept);
    if (of_object) return add(now, World::full, kept_by(bsdf, wo, direct.light.wi));
    if (now.min() == 1 && now.max() == 1) return add(now, World::both, 1);
    const float kept = at_first_catcher() ? float(state.effects->shadow) : state.kept;
    add(now, World::full, kept);
    add(visibility(true), World::set, kept);
}

template <Scatters B>
void TwoWorlds::leave(const PathState&, const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample) {
    state.through_glass = state.through_glass || bsdf.bounds_volume();
    if (sample.transmitted && sample.specular && !bsdf.bounds_volume()) return;   // a window
    if (state.first_catcher == FirstCatcher::left) state.first_catcher = FirstCatcher::behind;
    if (state.world != World::both || !at_first_catcher()) return;
    state.kept = sample.specular ? float(state.effects->reflection) : kept_by(bsdf, hit.wo, sample.wi);
    state.first_catcher = FirstCatcher::left;
}

/// Share of light from a direction that counts, if objects send it or block it.
template <Scatters B>
float TwoWorlds::kept_by(const B& bsdf, Vec3f wo, Vec3f wi) const {
    if (!at_first_catcher() || state.effects->all()) return state.kept;
    const float diffuse = bsdf.diffuse_share(wo, wi);
    return diffuse * float(state.effects->gi) + (1 - diffuse) * float(state.effects->reflection);
}

}  // namespace dg
