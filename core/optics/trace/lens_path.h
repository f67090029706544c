// lens_path.h -- the surfaces that light meets, in order: straight through the lens, or by way
// of two reflections, a ghost.
#pragma once
#include <span>
#include <vector>

#include "optics/trace/intersect.h"

namespace dg {

/// `sign`: of the way along z on which the light arrives. What is reflected goes on
/// against it.
struct PathStep {
    int surface;
    int sign = 1;
    bool reflects = false;

    /// Index of the medium before and behind the surface, as the light meets it.
    int before() const { return sign > 0 ? surface : surface + 1; }
    int behind() const { return sign > 0 ? surface + 1 : surface; }
};

using LensPath = std::vector<PathStep>;

/// Through all surfaces.
LensPath straight_path(int surfaces, bool toward_film);

/// Light from the scene is reflected at `far`, then back at `near` (near < far), and
/// leaves as it came: to the film, or on the same way from the film to the scene.
LensPath ghost_path(int surfaces, int near, int far, bool toward_film);

/// The same by any even number of mirrors, in the order in which light from the scene meets them: the first
/// lies farther along than the second, that nearer than the third, and so on. The first may lie behind all
/// surfaces that light leaves by: a sensor.
LensPath ghost_path(int surfaces, std::span<const int> mirrors, bool toward_film);

/// Mirrored in the surface's frame.
template <typename T>
Vec3<T> reflect(const Vec3<T>& direction, const LensHit<T>& hit, int sign) {
    return direction - (2.0 * sign * hit.cosine) * hit.normal;
}

template <typename T>
struct RayOf {
    Vec3<T> origin, direction;
};

/// Past one surface, for whose form the step is; mu = n before / n behind. False: a miss
/// or total reflection, with the ray as it was.
template <typename T>
bool pass(const SurfaceForm& form, const PathStep& step, double mu, RayOf<T>& ray) {
    const Vec3<T> d = form.place.turn_in(ray.direction);
    const auto hit = meet(form, form.place.into(ray.origin), d, step.sign);
    if (!hit) return false;
    T cosine;
    const auto bent = step.reflects ? reflect(d, *hit, step.sign)
                                    : refract(d, *hit, step.sign, mu, cosine);
    if (!bent) return false;
    ray = {form.place.out_of(hit->point), form.place.turn_out(*bent)};
    return true;
}

}  // namespace dg
