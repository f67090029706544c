// two_worlds.h -- a path in a scene with catchers, for compositing over a photograph.
//
// Catchers are models of the things in the photograph: Debevec's local scene. Compositing adds to the photograph the
// radiance of catchers with the objects in the scene, minus their radiance without objects (differential rendering;
// Debevec 1998, Rendering Synthetic Objects into Real Scenes, SIGGRAPH). So there are two worlds, with objects and
// without. One path serves both as long as they agree. They part where the path hits an object, or where an object
// shadows a light. In the world with objects the path continues at the object; in the world without objects it passes
// through. Both draw the same random numbers, so the noise of light that the worlds have in common cancels in the
// difference.
//
// The effects of a catcher (CatcherEffects) select the differences that are gathered, at the first catcher that the
// camera sees: the weight of a difference is 1 if its effect is on, and 0 if it is off.
//
// A plate is the photograph as a light source for objects: where a path from an object hits a catcher, it gathers the
// radiance in the photograph instead of following the path for it. From there the path gathers only the difference that
// objects make to that radiance.
#pragma once
#include <cstdint>
#include <utility>

#include "material/bsdf_sample.h"
#include "material/material.h"
#include "transport/walk/direct_light.h"
#include "transport/walk/path_state.h"

namespace dg {

/// The worlds in which the path continues.
enum class World : std::uint8_t { both, with_objects, without_objects };

class TwoWorlds {
  public:
    /// Position of the path relative to its first catcher: not yet hit, the current vertex, the previous vertex (the
    /// path is on the segment after the catcher), or an earlier vertex.
    enum class FirstCatcher : std::uint8_t { ahead, at_vertex, on_next_segment, behind };
    /// Whether a camera ray is behind an object, and why it went on there: through a clear sheet of the world with
    /// objects, or because the object is absent in the world without objects.
    enum class PastObject : std::uint8_t { not_behind, through_sheet, object_absent };

    /// Saved where a path branches.
    struct State {
        World world = World::with_objects;
        bool camera_sees_catcher = false;   // or background: light goes to Sight::with and without; false: Sight::light
        bool through_glass = false;   // the path passed a boundary of a volume
        bool plate_shown = false;     // a catcher's radiance was gathered from the plate: now only differences are
        PastObject past_object = PastObject::not_behind;
        FirstCatcher first_catcher = FirstCatcher::ahead;
        const CatcherEffects* effects = nullptr;   // of the first catcher; null before it is hit
        float difference_weight = 1;  // factor on differences between the worlds: the weight of the effect in question
        float plate_weight = 1;       // product of `difference_weight` at all catchers gathered from the plate
    };
    State state;

    explicit TwoWorlds(const Scene& scene) {
        if (scene.has_catchers()) state.world = World::both, state.camera_sees_catcher = true;
    }

    bool finds_first_hit() const { return state.world != World::without_objects; }

    void gather(PathState& path, Spectrum light, bool hero) const {
        gather(path, light, hero, state.difference_weight);
    }
    /// Adds emission that the path hit.
    void gather_emission(PathState& path, Spectrum light) const;
    /// Adds a light sample. `visibility(without_objects)`: visibility of the light in the world without objects, or
    /// with them; `reflected(visible)`: contribution of the light sample for that visibility.
    template <Scatters B, typename Visibility, typename Reflected>
    void gather_direct(PathState& path, const B& bsdf, Vec3f wo, const DirectLight& direct,
                       const Visibility& visibility, const Reflected& reflected);

    /// Processes a hit by Path::arrive(). The worlds part at an object. False: the path ends.
    template <typename Path>
    bool arrive(Path& path, Scene::Hit& found, int vertex, bool gathers);
    /// False: the background does not contribute to the path.
    bool sees_background(PathState& path);
    /// Adds the background from the plate. False: the plate does not show it.
    bool show_plate_sky(PathState& path) const;
    void meet_sphere(PathState& path, std::uint32_t sphere);
    /// False: the path ends.
    bool meet_surface(PathState& path, const SurfaceHit& hit);
    /// Adds the radiance of a catcher from the plate.
    void show_plate(PathState& path, const Material& material, const SurfaceHit& hit);

    /// Updates the state when the path leaves a vertex or a window.
    template <Scatters B>
    void leave(const PathState& path, const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample);
    /// Reduces the surface's coverage by the share of the ray that continues behind it.
    void uncover(PathState& path, const SurfaceHit& hit) const {
        if (!path.scene.catcher(hit.instance)) cover(path, hit.instance, -1);
    }

  private:
    bool at_first_catcher() const { return state.first_catcher == FirstCatcher::at_vertex; }
    bool parts_at(const PathState& path, const Scene::Hit& found) const;
    bool look_through(PathState& path);
    void cover(PathState& path, std::uint32_t object, float sign) const;
    void gather(PathState& path, Spectrum light, bool hero, float weight) const;
    bool plate_is_seen(const PathState& path) const;
    template <Scatters B>
    float lobe_weight(const B& bsdf, Vec3f wo, Vec3f wi) const;

    /// Share of the camera ray that passes objects through smooth glass. Branches do not restore it: the world with
    /// objects is followed first and adds to it, then the world without objects reads it.
    float share_through_glass_ = 0;
};

template <typename Path>
bool TwoWorlds::arrive(Path& path, Scene::Hit& found, int vertex, bool gathers) {
    if (!parts_at(path, found)) return path.arrive(found, vertex, gathers);
    const bool from_camera = path.walk.unscattered;   // the camera sees the object
    path.branch_off(0, [&] {
        state.world = World::with_objects;
        if (from_camera) state.camera_sees_catcher = false;
        if (state.difference_weight > 0 && path.arrive(found, vertex, gathers)) path.follow_to_end(vertex);
    });
    // The world without objects has been branched off already, at the object with the sheet.
    if (from_camera && state.past_object == PastObject::through_sheet) return false;
    state.world = World::without_objects;
    if (from_camera) state.past_object = PastObject::object_absent;
    path.walk.ray.without_objects = true;
    return path.step(vertex);
}

template <Scatters B, typename Visibility, typename Reflected>
void TwoWorlds::gather_direct(PathState& path, const B& bsdf, Vec3f wo, const DirectLight& direct,
                              const Visibility& visibility, const Reflected& reflected) {
    const bool of_object = state.world != World::with_objects && path.scene.is_of_object(direct.light.light);
    if (of_object && state.world == World::without_objects) return;
    const auto add = [&](Spectrum visible, World world, float weight) {
        if (visible.is_black()) return;
        const World current = std::exchange(state.world, world);
        gather(path, reflected(visible), direct.f.hero_only || path.walk.hero_only, weight);
        state.world = current;
    };
    const Spectrum visible = visibility(state.world == World::without_objects);
    if (state.world != World::both) return add(visible, state.world, state.difference_weight);
    if (of_object) return add(visible, World::with_objects, lobe_weight(bsdf, wo, direct.light.wi));
    if (visible.min() == 1 && visible.max() == 1) return add(visible, World::both, 1);   // no object shadows the light
    const float weight = at_first_catcher() ? float(state.effects->shadow) : state.difference_weight;
    add(visible, World::with_objects, weight);
    add(visibility(true), World::without_objects, weight);
}

template <Scatters B>
void TwoWorlds::leave(const PathState&, const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample) {
    state.through_glass = state.through_glass || bsdf.bounds_volume();
    if (sample.transmitted && sample.specular && !bsdf.bounds_volume()) return;   // a window
    // At the vertex after the catcher:
    if (state.first_catcher == FirstCatcher::on_next_segment) state.first_catcher = FirstCatcher::behind;
    // At the catcher: objects that the next ray hits make a difference of this effect.
    if (state.world != World::both || !at_first_catcher()) return;
    state.difference_weight = sample.specular ? float(state.effects->reflection) : lobe_weight(bsdf, hit.wo, sample.wi);
    state.first_catcher = FirstCatcher::on_next_segment;
}

/// Weight of the difference that objects make to light from the direction `wi`: the weights of the gi and reflection
/// effects, mixed by the diffuse share of the BSDF.
template <Scatters B>
float TwoWorlds::lobe_weight(const B& bsdf, Vec3f wo, Vec3f wi) const {
    if (!at_first_catcher() || state.effects->all()) return state.difference_weight;
    const float diffuse = bsdf.diffuse_share(wo, wi);
    return diffuse * float(state.effects->gi) + (1 - diffuse) * float(state.effects->reflection);
}

}  // namespace dg
