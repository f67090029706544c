#include "transport/catcher/two_worlds.h"

#include "transport/catcher/plate_view.h"

namespace dg {

/// `weight`: factor on light that reaches only the current world.
void TwoWorlds::gather(PathState& path, Spectrum light, bool hero, float weight) const {
    Sight& sight = path.sight;
    const auto add = [&](Radiance& to, float share) {
        if (share != 0) (hero ? to.hero : to.shared) += light * (share * state.plate_share);
    };
    if (state.plate_shown) {
        const float sign = state.world == World::both ? 0 : state.world == World::full ? weight : -weight;
        return add(state.for_set ? sight.with : sight.light, sign);
    }
    if (!state.for_set) return add(sight.light, 1);
    if (state.past_object == PastObject::in_set) weight = 1 - share_through_glass_;
    if (state.world != World::full && state.past_object != PastObject::through_sheet) add(sight.without, 1);
    const float share = state.world == World::both ? 1 : state.world == World::full ? weight : 1 - weight;
    add(sight.with, share);
}

/// An emitter hit by BSDF sampling at the first catcher has the weight of the shadow effect, as in light sampling: only
/// an object that casts a shadow makes the worlds differ there.
void TwoWorlds::gather_emission(PathState& path, Spectrum light) const {
    const bool shadow = state.first_catcher == FirstCatcher::left && state.world == World::set;
    gather(path, light, path.walk.hero_only, shadow ? float(state.effects->shadow) : state.difference_weight);
}

/// The worlds part at objects. Sphere lights and catchers belong to the set, so both worlds contain them.
bool TwoWorlds::parts_at(const PathState& path, const Scene::Hit& found) const {
    return found.sphere_light < 0 && state.world == World::both && !path.scene.catcher(found.surface.instance);
}

bool TwoWorlds::sees_background(PathState& path) {
    if (!path.walk.open) return true;
    if (!path.scene.has_catchers()) return path.settings.background != Background::transparent;
    if (state.through_glass) return look_through(path);
    return state.for_set = true;
}

void TwoWorlds::meet_sphere(PathState& path, std::uint32_t sphere) {
    if (path.walk.open && path.scene.has_catchers()) state.for_set = true;
    else cover(path, Cover::kSpheres + sphere, 1);
}

bool TwoWorlds::meet_surface(PathState& path, const SurfaceHit& hit) {
    const CatcherEffects* catcher = path.scene.catcher(hit.instance);
    if (!catcher) {
        cover(path, hit.instance, 1);
        return true;
    }
    if (path.walk.open) {
        if (state.through_glass) return look_through(path);
        // Past an object, through a sheet: here the worlds are one again, as effects of the catcher may be off.
        if (state.world == World::full) state.world = World::both, state.past_object = PastObject::through_sheet;
        state.for_set = true;
    }
    if (state.for_set && !state.effects) state.effects = catcher, state.first_catcher = FirstCatcher::here;
    return true;
}

/// Glass that is open for alpha shows the background along the unrefracted ray, which the set's world gathers. Ends
/// this path: always false.
bool TwoWorlds::look_through(PathState& path) {
    share_through_glass_ += path.walk.share();
    return false;
}

void TwoWorlds::cover(PathState& path, std::uint32_t object, float sign) const {
    if (state.world != World::set) path.cover(object, sign);
}

/// Whether the path has left an object, so that it sees the set in the plate.
bool TwoWorlds::plate_is_seen(const PathState& path) const {
    return path.settings.plate && state.world == World::full && !path.walk.open;
}

/// Only after a specular bounce: after other bounces light sampling has added the environment's light.
bool TwoWorlds::show_plate_sky(PathState& path) const {
    if (!plate_is_seen(path) || !path.walk.last.delta) return false;
    const auto shown = plate_of_sky(path);
    if (shown) gather(path, path.walk.throughput * path.wavelengths.emission(*shown), path.walk.hero_only);
    return shown.has_value();
}

/// Emitters of the set are excluded, as light sampling adds their light.
void TwoWorlds::show_plate(PathState& path, const Material& material, const SurfaceHit& hit) {
    const CatcherEffects* catcher = path.scene.catcher(hit.instance);
    if (!catcher || !plate_is_seen(path) || emits(material)) return;
    const auto shown = plate_of_surface(path, hit);
    if (!shown) return;
    state.plate_share *= state.difference_weight;
    state.plate_shown = false;
    gather(path, path.walk.throughput * path.wavelengths.emission(*shown), path.walk.hero_only, 1);
    state.plate_shown = true, state.world = World::both;
    state.effects = catcher, state.first_catcher = FirstCatcher::here, state.difference_weight = 1;
}

}  // namespace dg
