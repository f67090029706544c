// one_world.h -- gathers light in a scene without catchers and plates: the counterpart of TwoWorlds (two_worlds.h),
// with the same functions, for the template parameter of Path. Functions and their comments: two_worlds.h.
#pragma once
#include "material/bsdf_sample.h"
#include "material/material.h"
#include "transport/walk/direct_light.h"
#include "transport/walk/path_state.h"

namespace dg {

class OneWorld {
  public:
    struct State {};   // nothing to save where a path branches
    State state;

    explicit OneWorld(const Scene&) {}

    bool finds_first_hit() const { return true; }

    void gather(PathState& path, Spectrum light, bool hero) const {
        (hero ? path.sight.light.hero : path.sight.light.any_hero) += light;
    }
    void gather_emission(PathState& path, Spectrum light) const { gather(path, light, path.walk.hero_only); }
    template <Scatters B, typename Visibility, typename Reflected>
    void gather_direct(PathState& path, const B&, Vec3f, const DirectLight& direct,
                       const Visibility& visibility, const Reflected& reflected) const {
        const Spectrum visible = visibility(false);
        if (!visible.is_black()) gather(path, reflected(visible), direct.f.hero_only || path.walk.hero_only);
    }

    template <typename Path>
    bool arrive(Path& path, Scene::Hit& found, int vertex, bool gathers) const {
        return path.arrive(found, vertex, gathers);
    }
    bool sees_background(PathState& path) const {
        return !(path.walk.unscattered && path.settings.background == Background::transparent);
    }
    bool show_plate_sky(PathState&) const { return false; }
    void meet_sphere(PathState& path, std::uint32_t sphere) const { path.cover(Cover::kSpheres + sphere, 1); }
    bool meet_surface(PathState& path, const SurfaceHit& hit) const {
        path.cover(hit.instance, 1);
        return true;
    }
    void show_plate(PathState&, const Material&, const SurfaceHit&) const {}

    template <Scatters B>
    void leave(const PathState&, const B&, const SurfaceHit&, const BsdfSample&) const {}
    void uncover(PathState& path, const SurfaceHit& hit) const { path.cover(hit.instance, -1); }
};

}  // namespace dg
