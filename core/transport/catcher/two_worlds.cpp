#include "transport/catcher/two_worlds.h"

#include "transport/catcher/plate_view.h"

namespace dg {

/// Adds the light to the sums of the worlds in which the path continues. `weight`: weight of the effect by which the
/// worlds differ in this light. Sight::with gets with_objects * weight + without_objects * (1 - weight): without the
/// effect, the catcher looks as if the objects were absent.
void TwoWorlds::gather(PathState& path, Spectrum light, bool hero, float weight) const {
    Sight& sight = path.sight;
    const auto add = [&](Radiance& to, float factor) {
        if (factor != 0) (hero ? to.hero : to.any_hero) += light * (factor * state.plate_weight);
    };
    if (state.plate_shown) {   // the plate holds the light of the world without objects: only the difference is missing
        const float factor = state.world == World::both ? 0 : state.world == World::with_objects ? weight : -weight;
        return add(state.camera_sees_catcher ? sight.with_objects : sight.light, factor);
    }
    if (!state.camera_sees_catcher) return add(sight.light, 1);
    // Behind an absent object, Sight::with gets the share of the ray that passes the object through glass.
    if (state.past_object == PastObject::object_absent) weight = 1 - share_through_glass_;
    // Behind a clear sheet, the branch without the object gathers Sight::without.
    if (state.world != World::with_objects && state.past_object != PastObject::through_sheet) add(sight.without_objects, 1);
    const float factor = state.world == World::both ? 1 : state.world == World::with_objects ? weight : 1 - weight;
    add(sight.with_objects, factor);
}

/// An emitter that BSDF sampling at the first catcher hits, in the world without objects only, is shadowed by an
/// object. So it has the weight of the shadow effect, as in light sampling.
void TwoWorlds::gather_emission(PathState& path, Spectrum light) const {
    const bool shadow = state.first_catcher == FirstCatcher::on_next_segment && state.world == World::without_objects;
    gather(path, light, path.walk.hero_only, shadow ? float(state.effects->shadow) : state.difference_weight);
}

/// The worlds part at objects. Both worlds contain catchers and sphere lights.
bool TwoWorlds::parts_at(const PathState& path, const Scene::Hit& found) const {
    return found.sphere_light < 0 && state.world == World::both && !path.scene.catcher(found.surface.instance);
}

bool TwoWorlds::sees_background(PathState& path) {
    if (!path.walk.unscattered) return true;
    if (!path.scene.has_catchers()) return path.settings.background != Background::transparent;
    if (state.through_glass) return look_through(path);
    state.camera_sees_catcher = true;
    return true;
}

void TwoWorlds::meet_sphere(PathState& path, std::uint32_t sphere) {
    if (path.walk.unscattered && path.scene.has_catchers()) state.camera_sees_catcher = true;
    else cover(path, Cover::kSpheres + sphere, 1);
}

bool TwoWorlds::meet_surface(PathState& path, const SurfaceHit& hit) {
    const CatcherEffects* catcher = path.scene.catcher(hit.instance);
    if (!catcher) {
        cover(path, hit.instance, 1);
        return true;
    }
    if (path.walk.unscattered) {
        if (state.through_glass) return look_through(path);
        // The camera sees this catcher through a clear sheet of an object. Both worlds are followed again from here, as
        // the effects of this catcher need its light without objects.
        if (state.world == World::with_objects) {
            state.world = World::both;
            state.past_object = PastObject::through_sheet;
        }
        state.camera_sees_catcher = true;
    }
    if (state.camera_sees_catcher && !state.effects) {
        state.effects = catcher;
        state.first_catcher = FirstCatcher::at_vertex;
    }
    return true;
}

/// With PathSettings::see_through, glass shows the background along the unrefracted ray. The world without objects,
/// which continues along that ray, gathers it. Ends this path: always false.
bool TwoWorlds::look_through(PathState& path) {
    share_through_glass_ += path.walk.share();
    return false;
}

void TwoWorlds::cover(PathState& path, std::uint32_t object, float sign) const {
    if (state.world != World::without_objects) path.cover(object, sign);
}

/// Whether the path comes from an object, which the photograph lights.
bool TwoWorlds::plate_is_seen(const PathState& path) const {
    return path.settings.plate && state.world == World::with_objects && !path.walk.unscattered;
}

/// Only after a specular bounce. After other bounces light sampling lights the object by the environment, not by the
/// plate.
bool TwoWorlds::show_plate_sky(PathState& path) const {
    if (!plate_is_seen(path) || !path.walk.last.delta) return false;
    const auto shown = plate_of_sky(path);
    if (shown) gather(path, path.walk.throughput * path.wavelengths.emission(*shown), path.walk.hero_only);
    return shown.has_value();
}

/// Adds the radiance of the plate once, then treats the catcher as the first of a camera path: both worlds are
/// followed, and only their differences are gathered. Catchers that emit are excluded, as light sampling adds their
/// light.
void TwoWorlds::show_plate(PathState& path, const Material& material, const SurfaceHit& hit) {
    const CatcherEffects* catcher = path.scene.catcher(hit.instance);
    if (!catcher || !plate_is_seen(path) || emits(material)) return;
    const auto shown = plate_of_surface(path, hit);
    if (!shown) return;
    state.plate_weight *= state.difference_weight;
    state.plate_shown = false;   // gather() then adds the light itself, not a difference
    gather(path, path.walk.throughput * path.wavelengths.emission(*shown), path.walk.hero_only, 1);
    state.plate_shown = true;
    state.world = World::both;
    state.effects = catcher;
    state.first_catcher = FirstCatcher::at_vertex;
    state.difference_weight = 1;
}

}  // namespace dg
