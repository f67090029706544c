// surroundings.cpp -- the solids around a point, for cameras inside them.
#include <algorithm>
#include <array>

#include "scene/scene.h"

namespace dg {
namespace {

constexpr int kMostHits = 256;   // along a ray

/// Instances that a ray has entered and not left.
class Entered {
  public:
    void add(std::uint32_t instance) {
        if (count_ < int(instances_.size())) instances_[std::size_t(count_++)] = instance;
    }
    /// False: the ray began inside.
    bool leave(std::uint32_t instance) {
        for (int i = count_ - 1; i >= 0; --i) {
            if (instances_[std::size_t(i)] != instance) continue;
            instances_[std::size_t(i)] = instances_[std::size_t(--count_)];
            return true;
        }
        return false;
    }

  private:
    std::array<std::uint32_t, 32> instances_;
    int count_ = 0;
};

/// Directions for votes about a point: no two opposite, none along an axis, which meshes are often aligned with.
constexpr std::array<Vec3f, 7> kVotes{{{0.35f, 0.86f, 0.37f}, {-0.61f, 0.23f, 0.76f}, {0.82f, -0.31f, 0.48f},
                                       {-0.27f, -0.78f, 0.56f}, {-0.91f, 0.37f, -0.18f}, {0.44f, 0.52f, -0.73f},
                                       {0.19f, -0.66f, -0.72f}}};

}  // namespace

void Scene::find_solids() {
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        const auto keys = keys_of(instance.material);
        if (std::ranges::any_of(keys, bounds_solid)) solids_.push_back({i, bounds_of(i)});
    }
}

std::vector<std::uint32_t> Scene::solids_near(const Box& box) const {
    const Vec3f low = to_float(box.min), high = to_float(box.max);
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < solids_.size(); ++i)
        if (solids_[i].bounds.meets(low, high)) near.push_back(i);
    return near;
}

/// Calls use(hit, bounds a medium) for each solid or medium around the origin of a ray, from the inside out: a ray
/// leaves it without having entered it. use() returns whether to go on.
template <typename Use>
void Scene::leave_solids(Ray ray, const Use& use) const {
    Entered entered;
    for (int i = 0; i < kMostHits; ++i) {
        const auto raw = intersector_->intersect(ray);
        if (!raw || raw->instance == RawHit::kSphere) return;
        SurfaceHit hit;
        find_surface(ray, *raw, hit);
        if (has_bounded_media_ && media_[hit.instance].bounds) {
            if (!use(hit, true)) return;
        } else if (std::ranges::binary_search(solids_, hit.instance, {}, &Solid::instance)) {
            if (hit.front) entered.add(hit.instance);
            else if (!entered.leave(hit.instance) && !use(hit, false)) return;
        }
        const RayCone cone = ray.cone;
        ray = spawn_ray(hit, ray.direction, ray.time);
        ray.cone = cone;
    }
}

std::optional<Interior> Scene::around(const Ray& ray, std::span<const std::uint32_t> near,
                                      const Wavelengths& wavelengths) const {
    const auto holds = [&](std::uint32_t i) { return solids_[i].bounds.meets(ray.origin, ray.origin); };
    if (std::ranges::none_of(near, holds)) return std::nullopt;
    Interior here;
    here.medium = fog_;
    leave_solids(ray, [&](SurfaceHit& hit, bool medium) {
        if (medium) {
            here = medium_on(hit.instance, !hit.front);
            return false;
        }
        const MaterialAt now = material(hit);
        here = interior(shade(now, textures(), hit, wavelengths));
        return false;
    });
    return here;
}

std::vector<Scene::Surrounding> Scene::surroundings(Vec3f point, float time) const {
    std::vector<Surrounding> found;
    if (solids_near({to_double(point), to_double(point)}).empty()) return found;
    for (const Vec3f direction : kVotes) {
        const Ray ray{.origin = point, .direction = normalize(direction), .time = time};
        leave_solids(ray, [&](SurfaceHit& hit, bool medium) {
            if (medium) return true;
            const auto known = std::ranges::find(found, hit.instance, &Surrounding::instance);
            if (known == found.end()) found.push_back({hit.instance, 1.f / kVotes.size()});
            else known->share += 1.f / kVotes.size();
            return true;
        });
    }
    return found;
}

}  // namespace dg
