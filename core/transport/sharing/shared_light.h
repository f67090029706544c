// shared_light.h -- MIS weights of a camera path against light paths, for emitters that it hits.
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
struct SharedLight {
    const FirstRay* first = nullptr;   // null once the path has left its first vertex; windows are no vertices
    PathMis* bounces = nullptr;        // null once light paths cannot find the continuation of the path

    bool off() const { return !first && !bounces; }

    /// Updates the state when the path leaves a vertex. `vertex` is null if `bounces` is null.
    void leave(PathMis::Vertex* vertex, const BsdfSample& sample) {
        first = nullptr;
        if (!vertex) return;
        bounces->leave(*vertex, sample);
        if (!bounces->open()) bounces = nullptr;
    }

    float left_of_sky(const EmitterMet& met) const {
        return first ? first->share_of_sky(met.direction).value_or(1.f) : left(LightSet::kEnvironment, met);
    }
    float left_of_sphere(const LightSet& lights, std::uint32_t sphere, const SurfaceHit& hit,
                         const EmitterMet& met) const {
        return first ? first->share_of_sphere(lights, sphere, hit).value_or(1.f)
                     : left(lights.sphere_index(sphere), met);
    }
    float left_of_triangle(const LightSet& lights, const SurfaceHit& hit, const EmitterMet& met) const {
        if (first) return first->share_of_triangle(hit).value_or(1.f);
        const std::int64_t light = lights.triangle_index(hit.instance, hit.primitive);
        return light < 0 ? 1 : left(light, met);
    }

  private:
    float left(std::int64_t light, const EmitterMet& met) const {
        if (!bounces) return 1;
        return bounces->of_emitter(light, met.from, met.direction, met.distance, met.time, met.light_over_bsdf);
    }
};

}  // namespace dg
