// two_worlds.h -- a path in a scene with catchers, for compositing over a photograph.
//
// Catchers model the set: the things visible in the photograph. Compositing adds the light of the set with objects
// minus its light without objects to the photograph (differential rendering; Debevec 1998, Rendering Synthetic Objects
// into Real Scenes, SIGGRAPH). So there are two worlds: the full scene, and the set alone. One path serves both as long
// as they agree. They part where the path hits an object, or where an object shadows a light: in the full world the
// path continues at the object, in the set's world it passes through the object. Both draw the same random numbers, so
// the noise of light that both worlds have in common cancels in the difference.
//
// The effects of a catcher (CatcherEffects) select the differences that count, at the first catcher that the camera
// sees: the weight of a difference is 1 if its effect is on, and 0 if it is off.
//
// A plate is the photograph as a light source for objects: where a path from an object hits a catcher, it takes the
// radiance from the photograph. After that only differences between the worlds are added.
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
    /// Position of the path relative to the first catcher that it hits.
    enum class FirstCatcher : std::uint8_t { ahead, here, left, behind };
    /// How a camera ray continues behind an object: through a clear sheet, or through the object in the set's world.
    enum class PastObject : std::uint8_t { no, through_sheet, in_set };

    /// Saved where a path branches.
    struct State {
        World world = World::full;
        bool for_set = false;         // gathered light is radiance of the set; false: of an object
        bool through_glass = false;   // the path passed smooth glass
        bool plate_shown = false;     // a catcher's radiance came from the plate: only differences count
        PastObject past_object = PastObject::no;
        FirstCatcher first_catcher = FirstCatcher::ahead;
        const CatcherEffects* effects = nullptr;   // of the first catcher; null before it is hit
        float difference_weight = 1;   // factor on differences between the worlds
        float plate_share = 1;        // product of `difference_weight` at catchers shown from the plate
    };
    State state;

    explicit TwoWorlds(const Scene& scene) {
        if (scene.has_catchers()) state.world = World::both, state.for_set = true;
    }

    bool finds_first_hit() const { return state.world != World::set; }

    void gather(PathState& path, Spectrum light, bool hero) const {
        gather(path, light, hero, state.difference_weight);
    }
    /// Adds emission that the path hit.
    void gather_emission(PathState& path, Spectrum light) const;
    /// Adds a light sample. `visibility(of_set)`: visibility of the light, in the set alone or in the full scene;
    /// `reflected(visible)`: contribution of the light sample for that visibility.
    template <Scatters B, typename Visibility, typename Reflected>
    void gather_direct(PathState& path, const B& bsdf, Vec3f wo, const DirectLight& direct,
                       const Visibility& visibility, const Reflected& reflected);

    /// Processes a hit. The worlds part at an object. False: the path ends.
    template <typename Path>
    bool arrive(Path& path, Scene::Hit& found, int vertex, bool counts);
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
    bool at_first_catcher() const { return state.first_catcher == FirstCatcher::here; }
    bool parts_at(const PathState& path, const Scene::Hit& found) const;
    bool look_through(PathState& path);
    void cover(PathState& path, std::uint32_t object, float sign) const;
    void gather(PathState& path, Spectrum light, bool hero, float weight) const;
    bool plate_is_seen(const PathState& path) const;
    template <Scatters B>
    float lobe_weight(const B& bsdf, Vec3f wo, Vec3f wi) const;

    /// Share of the camera ray that passes objects through smooth glass. Branches do not restore it: the full world
    /// adds to it before the set's world reads it.
    float share_through_glass_ = 0;
};

template <typename Path>
bool TwoWorlds::arrive(Path& path, Scene::Hit& found, int vertex, bool counts) {
    if (!parts_at(path, found)) return path.arrive(found, vertex, counts);
    const bool from_camera = path.walk.open;
    path.aside(0, [&] {
        state.world = World::full;
        if (from_camera) state.for_set = false;
        if (state.difference_weight > 0 && path.arrive(found, vertex, counts)) path.follow_to_end(vertex);
    });
    // Behind an earlier object, the branch at that object gathers the set's world.
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
    const auto add = [&](Spectrum visible, World world, float weight) {
        if (visible.is_black()) return;
        const World here = std::exchange(state.world, world);
        gather(path, reflected(visible), direct.f.hero_only || path.walk.hero_only, weight);
        state.world = here;
    };
    const Spectrum now = visibility(state.world == World::set);
    if (state.world != World::both) return add(now, state.world, state.difference_weight);
    if (of_object) return add(now, World::full, lobe_weight(bsdf, wo, direct.light.wi));
    if (now.min() == 1 && now.max() == 1) return add(now, World::both, 1);
    const float weight = at_first_catcher() ? float(state.effects->shadow) : state.difference_weight;
    add(now, World::full, weight);
    add(visibility(true), World::set, weight);
}

template <Scatters B>
void TwoWorlds::leave(const PathState&, const B& bsdf, const SurfaceHit& hit, const BsdfSample& sample) {
    state.through_glass = state.through_glass || bsdf.bounds_volume();
    if (sample.transmitted && sample.specular && !bsdf.bounds_volume()) return;   // a window
    if (state.first_catcher == FirstCatcher::left) state.first_catcher = FirstCatcher::behind;
    if (state.world != World::both || !at_first_catcher()) return;
    state.difference_weight = sample.specular ? float(state.effects->reflection) : lobe_weight(bsdf, hit.wo, sample.wi);
    state.first_catcher = FirstCatcher::left;
}

/// Weight of light from a direction that objects emit, reflect or block: the weights of the gi and reflection effects,
/// mixed by the diffuse share of the BSDF.
template <Scatters B>
float TwoWorlds::lobe_weight(const B& bsdf, Vec3f wo, Vec3f wi) const {
    if (!at_first_catcher() || state.effects->all()) return state.difference_weight;
    const float diffuse = bsdf.diffuse_share(wo, wi);
    return diffuse * float(state.effects->gi) + (1 - diffuse) * float(state.effects->reflection);
}

}  // namespace dg
