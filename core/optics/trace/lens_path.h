// lens_path.h -- sequence of surfaces along a path of light: straight through the lens, or a ghost
// with two or more reflections.
#pragma once
#include <span>
#include <vector>

#include "optics/trace/intersect.h"

namespace dg {

/// Interaction with one surface. `sign` is the direction along z of the incident light; reflected
/// light continues in the opposite direction.
struct PathStep {
    int surface;
    int sign = 1;
    bool reflects = false;

    /// Indices of the media in front of and behind the surface, in the direction of travel.
    int before() const { return sign > 0 ? surface : surface + 1; }
    int behind() const { return sign > 0 ? surface + 1 : surface; }
};

using LensPath = std::vector<PathStep>;

/// Path through all surfaces without reflection.
LensPath straight_path(int surfaces, bool toward_film);

/// Ghost path: light from the scene is reflected at `far`, then at `near` (near < far), and
/// continues to the film. With toward_film false, the same path from the film to the scene.
LensPath ghost_path(int surfaces, int near, int far, bool toward_film);

/// Ghost path with any even number of mirrors, in the order in which light from the scene hits
/// them: the first is behind the second, the second in front of the third, and so on. The first may
/// be behind all surfaces that the light leaves through: a sensor.
LensPath ghost_path(int surfaces, std::span<const int> mirrors, bool toward_film);

/// Mirror reflection in the surface's frame.
template <typename T>
Vec3<T> reflect(const Vec3<T>& direction, const LensHit<T>& hit, int sign) {
    return direction - (2.0 * sign * hit.cosine) * hit.normal;
}

template <typename T>
struct RayOf {
    Vec3<T> origin, direction;
};

/// Refracts or reflects a ray at the surface of the step; mu = n before / n behind. Returns false
/// after a miss or total reflection and leaves the ray unchanged.
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
