// light_path_mis.h -- MIS weights of a camera path against light paths, for emitters that it hits. Light paths directly
// to the lens (first_ray.h) can find emitters on the first ray; light paths with bounces (path_mis.h) all others.
#pragma once
#include "light/light.h"
#include "transport/sharing/first_ray.h"
#include "transport/sharing/path_mis.h"

namespace dg {

/// An emitter hit by a camera path.
struct EmitterMet {
    Vec3f from, direction;         // the last vertex, m; unit
    float distance, time;          // from the last vertex, m; time of the ray
    float light_over_bsdf;         // density of light sampling over density of BSDF sampling
};

/// State of the MIS with light paths. Off if light paths cannot find the light of this path.
struct LightPathMis {
    const FirstRay* first_ray = nullptr;   // null once the path has left its first vertex; windows are no vertices
    PathMis* path_mis = nullptr;           // null once light paths cannot find the continuation of the path

    bool off() const { return !first_ray && !path_mis; }

    /// Updates the state when the path leaves a vertex. `vertex` is null if `path_mis` is null.
    void leave(PathMis::Vertex* vertex, const BsdfSample& sample) {
        first_ray = nullptr;
        if (!vertex) return;
        path_mis->leave(*vertex, sample);
        if (!path_mis->open()) path_mis = nullptr;
    }

    float weight_of_sky(const EmitterMet& met) const {
        return first_ray ? first_ray->weight_of_sky(met.direction).value_or(1.f)
                         : weight_of(LightSet::kEnvironment, met);
    }
    float weight_of_sphere(const LightSet& lights, std::uint32_t sphere, const SurfaceHit& hit,
                           const EmitterMet& met) const {
        return first_ray ? first_ray->weight_of_sphere(lights, sphere, hit).value_or(1.f)
                         : weight_of(lights.sphere_index(sphere), met);
    }
    float weight_of_triangle(const LightSet& lights, const SurfaceHit& hit, const EmitterMet& met) const {
        if (first_ray) return first_ray->weight_of_triangle(hit).value_or(1.f);
        const std::int64_t light = lights.triangle_index(hit.instance, hit.primitive);
        return light < 0 ? 1 : weight_of(light, met);
    }

  private:
    float weight_of(std::int64_t light, const EmitterMet& met) const {
        if (!path_mis) return 1;
        return path_mis->weight_of_emitter(light, met.from, met.direction, met.distance, met.time, met.light_over_bsdf);
    }
};

}  // namespace dg
