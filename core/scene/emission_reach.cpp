// emission_reach.cpp -- bounds of lit surfaces, and specular objects to aim light paths at.
#include "material/material_needs.h"
#include "scene/instance_bounds.h"
#include "scene/scene.h"

namespace dg {
namespace {

// Limit of specular objects that are aimed at; the largest are kept.
constexpr std::size_t kMostAims = 16;
// Relative size above which objects are hit often without aiming.
constexpr float kLargeAim = 0.5f;

Sphere ball_around(Vec3f min, Vec3f max) {
    return {(min + max) * 0.5f, 0.5f * length(max - min)};
}

void widen(Vec3f& min, Vec3f& max, Vec3f a, Vec3f b) {
    for (int k = 0; k < 3; ++k) {
        min[k] = std::min(min[k], a[k]);
        max[k] = std::max(max[k], b[k]);
    }
}

}  // namespace

/// Bounds of an instance over all times.
Scene::Bounds Scene::bounds_of(std::uint32_t i) const {
    const Instance& instance = description_.instances[i];
    if (instance.motion) {
        const Box box = intersector_->bounds_of_moving(i);
        return {to_float(box.min), to_float(box.max)};
    }
    return bounds_of_still(description_.meshes[instance.mesh], instance);
}

EmissionReach Scene::emission_reach() const {
    EmissionReach reach;
    Vec3f min = bounds_.min, max = bounds_.max;
    reach.lit = ball_around(min, max);
    for (const Keyed<Sphere>& sphere : spheres())
        for (const Sphere& s : sphere.values) {
            const Vec3f r{s.radius, s.radius, s.radius};
            widen(min, max, s.center - r, s.center + r);
        }
    reach.all = ball_around(min, max);
    std::vector<Sphere> balls;
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        if (description_.meshes[instance.mesh].empty()) continue;
        if (!std::ranges::any_of(keys_of(instance.material), makes_caustics)) continue;
        const Bounds b = bounds_of(i);
        const Sphere ball = ball_around(b.min, b.max);
        if (ball.radius > 0 && ball.radius < kLargeAim * reach.lit.radius) balls.push_back(ball);
    }
    std::ranges::sort(balls, std::ranges::greater{}, &Sphere::radius);
    if (balls.size() > kMostAims) balls.resize(kMostAims);
    reach.aim = EmissionAim(std::move(balls));
    return reach;
}

}  // namespace dg
