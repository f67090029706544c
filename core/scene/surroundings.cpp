// surroundings.cpp -- the solids around a path, and around a camera.
#include <algorithm>
#include <array>
#include <limits>

#include "scene/instance_bounds.h"
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

/// Directions of rays that vote whether a point is inside a mesh: none along an axis, with which meshes are often
/// aligned, and no opposite pairs.
constexpr std::array<Vec3f, 7> kVotes{{{0.35f, 0.86f, 0.37f}, {-0.61f, 0.23f, 0.76f}, {0.82f, -0.31f, 0.48f},
                                       {-0.27f, -0.78f, 0.56f}, {-0.91f, 0.37f, -0.18f}, {0.44f, 0.52f, -0.73f},
                                       {0.19f, -0.66f, -0.72f}}};

}  // namespace

void Scene::find_solids() {
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        if (std::ranges::any_of(keys_of(instance.material), bounds_solid))
            solids_.push_back({i, bounds_over_time(description_.meshes[instance.mesh], instance)});
    }
    ranks_ = rank_solids(description_, solids_);
}

SolidOptics Scene::optics_in(std::uint32_t instance, float time, const Wavelengths& wavelengths) const {
    const MaterialAt now = material_at(records_[instance].material, time);
    return solid_optics(now, wavelengths);
}

bool Scene::resolve_boundary(const Solids& solids, SurfaceHit& hit, const Wavelengths& wavelengths) const {
    Solids beyond = solids;   // solids on the other side, without the solid of the boundary
    cross_coincident(beyond, hit, true);
    const std::uint32_t here = solids.top(ranks_.of_instance, hit.instance),
                        there = beyond.top(ranks_.of_instance, hit.instance);
    const std::uint32_t inner = hit.front ? there : here;   // the highest other solid on the boundary's inner side
    if (inner != Solids::kNone && rank(inner) > rank(hit.instance)) return false;
    const std::uint32_t outside = hit.front ? here : there;
    if (outside != Solids::kNone) {
        const SolidOptics optics = optics_in(outside, hit.time, wavelengths);
        hit.outside_ior = optics.ior, hit.outside_disperses = optics.disperses;
    }
    return true;
}

void Scene::cross_boundary(Solids& solids, const SurfaceHit& hit, bool entering) const {
    entering ? solids.enter(hit.instance) : solids.leave(hit.instance);
    cross_coincident(solids, hit, entering == hit.front);
}

/// Crosses the boundaries of other solids at the place of a hit: water that touches its glass. The next ray begins
/// beyond them. `onward`: from the side of hit.wo to the other.
void Scene::cross_coincident(Solids& solids, const SurfaceHit& hit, bool onward) const {
    if (!ranks_.touches[hit.instance]) return;
    constexpr float kErrors = 16;   // multiples of hit.error within which boundaries coincide, as in solid_ranks.cpp
    const float reach = kErrors * hit.error / std::max(std::abs(dot(hit.ng, hit.wo)), 0.05f);
    const Ray ray{.origin = hit.position + hit.wo * reach, .direction = -hit.wo, .time = hit.time, .t_max = 2 * reach};
    Crossings crossings(true);
    intersector_->occluded(ray, &crossings);
    for (std::uint32_t i = 0; i < crossings.count; ++i) {
        const RawHit& raw = crossings.hits[i];
        if (raw.instance == hit.instance || rank(raw.instance) == 0) continue;
        SurfaceHit other;
        find_surface(ray, raw, other);
        other.front == onward ? solids.enter(raw.instance) : solids.leave(raw.instance);
    }
}

Interior Scene::interior_in(const Solids& solids, float time, const Wavelengths& wavelengths) const {
    const std::uint32_t top = solids.top(ranks_.of_instance);
    if (top != Solids::kNone) {
        if (has_media_ && media_[top].inside) return medium_on(top, true);
        return optics_in(top, time, wavelengths).interior;
    }
    Interior outside;
    outside.medium = fog_;
    return outside;
}

void Scene::cross_nested(Surroundings& here, const SurfaceHit& hit, bool entering,
                         const Wavelengths& wavelengths) const {
    cross_boundary(here.solids, hit, entering);
    here.interior = interior_in(here.solids, hit.time, wavelengths);
}

std::vector<std::uint32_t> Scene::solids_near(const Box& box) const {
    const Vec3f low = to_float(box.min), high = to_float(box.max);
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < solids_.size(); ++i)
        if (solids_[i].bounds.meets(low, high)) near.push_back(i);
    return near;
}

/// Calls use(hit, is_medium) for each solid or medium that contains the origin of a ray, from the inside out: the ray
/// leaves it without having entered it. use() returns whether to continue.
template <typename Use>
void Scene::leave_solids(Ray ray, const Use& use) const {
    Entered entered;
    ray.t_max = std::numeric_limits<float>::infinity();
    for (int i = 0; i < kMostHits; ++i) {
        const auto raw = first_surface(ray);
        if (!raw) return;
        SurfaceHit hit;
        find_surface(ray, *raw, hit);
        if (has_bounded_media_ && media_[hit.instance].bounds) {
            if (!use(hit, true)) return;
        } else if (std::ranges::binary_search(solids_, hit.instance, {}, &BoundedSolid::instance)) {
            if (hit.front) entered.add(hit.instance);
            else if (!entered.leave(hit.instance) && !use(hit, false)) return;
        }
        const RayCone cone = ray.cone;
        ray = spawn_ray(hit, ray.direction, ray.time);
        ray.cone = cone;
    }
}

std::optional<Surroundings> Scene::around(const Ray& ray, std::span<const std::uint32_t> near,
                                          const Wavelengths& wavelengths) const {
    const auto holds = [&](std::uint32_t i) { return solids_[i].bounds.meets(ray.origin, ray.origin); };
    if (std::ranges::none_of(near, holds)) return std::nullopt;
    Surroundings here;
    here.interior.medium = fog_;
    leave_solids(ray, [&](SurfaceHit& hit, bool medium) {
        if (medium) {
            if (here.solids.empty()) here.interior = medium_on(hit.instance, !hit.front);
            return false;
        }
        if (rank(hit.instance) > 0) {
            here.solids.enter(hit.instance);
            return true;
        }
        const MaterialAt now = material(hit);
        if (here.solids.empty()) here.interior = interior(shade(now, textures(), hit, wavelengths));
        return false;
    });
    if (!here.solids.empty()) here.interior = interior_in(here.solids, ray.time, wavelengths);
    return here;
}

bool Scene::begins_in_solid(const Ray& ray) const {
    if (std::ranges::none_of(solids_, [&](const BoundedSolid& s) { return s.bounds.meets(ray.origin, ray.origin); }))
        return false;
    bool inside = false;
    leave_solids(ray, [&](SurfaceHit&, bool medium) {
        inside = !medium;
        return medium;
    });
    return inside;
}

std::vector<EnclosingSolid> Scene::enclosing_solids(Vec3f point, float time) const {
    std::vector<EnclosingSolid> found;
    if (solids_near({to_double(point), to_double(point)}).empty()) return found;
    for (const Vec3f direction : kVotes) {
        const Ray ray{.origin = point, .direction = normalize(direction), .time = time};
        leave_solids(ray, [&](SurfaceHit& hit, bool medium) {
            if (medium) return true;
            const auto known = std::ranges::find(found, hit.instance, &EnclosingSolid::instance);
            if (known == found.end()) found.push_back({hit.instance, 1.f / kVotes.size()});
            else known->share += 1.f / kVotes.size();
            return true;
        });
    }
    return found;
}

}  // namespace dg
