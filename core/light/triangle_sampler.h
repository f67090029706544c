// triangle_sampler.h -- a triangle light with precomputed edges and area.
#pragma once
#include "light/emitter.h"
#include "math/warp.h"

namespace dg {

struct alignas(64) TriangleSampler {   // a cache line: with many lamps, each access is a miss
    Vec3f a, to_b, to_c;  // m
    Rgb luminance;        // cd/m2, mean
    float area = 0;       // m2; 0: not a triangle
    float error = 0;      // m: error bound perpendicular to its plane, from rounding of the corners in the ray tracer
    std::uint32_t light = 0;   // index among all lights
    bool two_sided = false, even = false, mirrored = false;
    bool moves = false;  // moving triangles have area 0

    TriangleSampler() = default;
    explicit TriangleSampler(const TriangleLight& t)
        : a(t.a),
          to_b(t.b - t.a),
          to_c(t.c - t.a),
          luminance(t.mean_luminance),
          two_sided(t.two_sided),
          even(t.even),
          mirrored(t.mirrored) {
        area = 0.5f * length(normal());
        error = lamp_error(std::max({largest_coordinate(t.a), largest_coordinate(t.b), largest_coordinate(t.c)}));
    }
    /// Normal of the front side with a length of twice the area.
    Vec3f normal() const { return mirrored ? -cross(to_b, to_c) : cross(to_b, to_c); }

    /// Uniform over the area. False if the position sees the dark side.
    bool sample(Vec2f u, Vec3f position, EmitterSample& out) const {
        const Vec2f b = warp_triangle(u);
        const Vec3f to = a + to_b * b.x + to_c * b.y - position;
        const float d2 = length_squared(to);
        if (!(d2 > 0)) return false;
        const float facing = -dot(to, normal());  // cos * distance * 2 area
        if (two_sided ? facing == 0 : facing <= 0) return false;
        const float d = std::sqrt(d2);
        const Vec3f wi = to * (1 / d);
        const float pdf = d2 * d / (0.5f * std::abs(facing));
        if (!(pdf < std::numeric_limits<float>::infinity())) return false;
        out = {wi, d, luminance, pdf, false, b, along_ray(2 * area * d / std::abs(facing))};
        return true;
    }
    /// Error bound along a ray, from the inverse cosine at the plane, and at most the longest side.
    float along_ray(float inverse_cos) const {
        const float along = error * inverse_cos;
        return along < 1e-3f ? along : std::min(along, length(to_b) + length(to_c));
    }
    /// Density, 1/sr, for a point at the distance `t` m.
    float pdf(float t, float cos_light) const {
        const float projected = std::abs(cos_light) * area;
        return projected > 0 ? t * t / projected : 0;
    }
};
static_assert(sizeof(TriangleSampler) == 64);

}  // namespace dg
