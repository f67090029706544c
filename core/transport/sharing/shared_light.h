// shared_light.h -- a camera path's part in multiple importance sampling with light paths: the share that light paths
// leave to it of an emitter that it meets.
#pragma once
#include "light/light.h"
#include "transport/sharing/first_ray.h"
#include "transport/sharing/path_mis.h"

namespace dg {

/// How a camera path came to an emitter.
struct EmitterMet {
    Vec3f from, direction;         // the last vertex, m; unit
    float distance, time;          // from there, m; of the ray
    float light_over_bsdf;         // pdf of light sampling over the pdf of the BSDF
};

/// Off: there are no light paths that could find what this path finds.
struct SharedLight {
    const FirstRay* first = nullptr;   // until the path has left its first vertex; windows are no vertices
    PathMis* bounces = nullptr;        // as long as light paths may find what comes next

    bool off() const { return !first && !bounces; }

    /// The path leaves a vertex. `vertex` is null if bounces is.
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
