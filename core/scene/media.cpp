// media.cpp -- media along rays.
#include "scene/media.h"

#include <cmath>
#include <limits>

#include "math/error.h"
#include "scene/scene.h"

namespace dg {
namespace {

void check_index(const char* what, std::int64_t index, std::size_t count) {
    if (index < std::int64_t(count)) return;
    throw input_error("media", what, "less than " + std::to_string(count), std::to_string(index));
}

}  // namespace

void validate(const SceneMedia& media, std::size_t materials) {
    check_index("fog", media.fog, media.all.size());
    for (const auto& [material, of] : media.of_material) {
        check_index("material index", material, materials);
        check_index("inside", of.inside, media.all.size());
        check_index("outside", of.outside, media.all.size());
    }
}

void Scene::find_media() {
    const SceneMedia& media = description_.media;
    if (media.empty()) return;
    has_media_ = true;
    const auto medium = [&](std::int32_t i) { return i < 0 ? nullptr : media.all[std::size_t(i)].get(); };
    fog_ = medium(media.fog);
    for (const Instance& instance : description_.instances) {
        MediaOfInstance& of = media_.emplace_back();
        of.outside = fog_;
        const auto found = media.of_material.find(instance.material);
        if (found == media.of_material.end()) continue;
        has_bounded_media_ = of.bounds = true;
        of.invisible = found->second.invisible;
        of.inside = medium(found->second.inside);
        if (found->second.outside >= 0) of.outside = medium(found->second.outside);
    }
}

/// The first surface along the ray that bounds a medium determines the medium at the origin.
Interior Scene::medium_around(Ray ray) const {
    Interior around;
    around.medium = fog_;
    if (!has_bounded_media_) return around;
    ray.t_max = std::numeric_limits<float>::infinity();
    constexpr int kMost = 256;
    for (int i = 0; i < kMost; ++i) {
        const auto raw = first_surface(ray);
        if (!raw) return around;
        SurfaceHit hit;
        find_surface(ray, *raw, hit);
        if (media_[hit.instance].bounds) return medium_on(hit.instance, !hit.front);
        const RayCone cone = ray.cone;
        ray = spawn_ray(hit, ray.direction, ray.time);
        ray.cone = cone;
    }
    return around;
}

/// Intersects the scene without lamp spheres, which bound neither solids nor media.
std::optional<RawHit> Scene::first_surface(Ray ray) const {
    for (;;) {
        const auto raw = intersector_->intersect(ray);
        if (!raw || raw->instance != RawHit::kSphere) return raw;
        ray.t_min = std::nextafter(raw->t * (1 + 1e-5f), std::numeric_limits<float>::infinity());
    }
}

/// Intersects the scene without surfaces that only separate media.
std::optional<RawHit> Scene::first_visible(Ray ray) const {
    for (;;) {
        const auto raw = intersector_->intersect(ray);
        if (!raw || raw->instance == RawHit::kSphere || !media_[raw->instance].invisible) return raw;
        SurfaceHit hit;
        find_surface(ray, *raw, hit);
        const float behind = raw->t + hit.error / std::max(std::abs(dot(hit.ng, ray.direction)), 1e-3f);
        ray.t_min = std::max(behind, std::nextafter(raw->t, std::numeric_limits<float>::infinity()));
    }
}

Interior Scene::medium_on(std::uint32_t instance, bool inside) const {
    const MediaOfInstance& of = media_[instance];
    Interior there;
    there.medium = inside ? of.inside : of.outside;
    if (inside) there.instance = instance;
    return there;
}

/// A participating medium replaces the absorption of a material.
Interior Scene::medium_behind(const Interior& here, std::uint32_t instance, const Interior& inside, bool bounds_volume,
                              bool entering) const {
    const bool bounds = media_[instance].bounds;
    if (!bounds && !bounds_volume) return here;
    Interior there = medium_on(instance, entering);
    if (entering && !there.medium) there = inside;
    return there;
}

GridRay Scene::grid_ray(const Interior& in, const Ray& ray) const {
    const DensityGrid& grid = *in.medium->density;
    Affine3d space_from_scene{.origin = origin()};
    if (in.instance != Interior::kWorld) {
        PlacementRoom made;
        space_from_scene = inverse(records_[in.instance].placement(ray.time, made).world_from_local);
        space_from_scene.origin += description_.instances[in.instance].local_origin;
    }
    const Affine3d unit_from_scene = grid.unit_from_space() * space_from_scene;
    return {grid, unit_from_scene.point(to_double(ray.origin)), unit_from_scene.vector(to_double(ray.direction))};
}

Spectrum Scene::through_medium(const Interior& in, const Ray& ray, float begin, float end,
                               const Wavelengths& wavelengths) const {
    const Spectrum extinction = in.medium->at(wavelengths).extinction;
    if (!in.medium->density) return transmittance(extinction, end - begin);
    return ratio_tracking(grid_ray(in, ray), extinction, double(begin), double(end),
                          RayRandom(ray.origin, ray.direction, begin));
}

}  // namespace dg
