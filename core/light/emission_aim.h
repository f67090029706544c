// emission_aim.h -- aims light paths at bounding spheres of specular objects, which are often small, so that more light
// paths find their caustics.
#pragma once
#include <vector>

#include "geometry/mesh.h"
#include "math/below_one.h"
#include "math/warp.h"

namespace dg {

class EmissionAim {
  public:
    EmissionAim() = default;
    explicit EmissionAim(std::vector<Sphere> balls) : balls_(std::move(balls)) {}
    bool empty() const { return balls_.empty(); }

    /// Samples a direction from a point to a sphere; spheres are equally likely, and u.x also chooses the sphere.
    Vec3f direction(Vec3f from, Vec2f u) const {
        const Sphere& ball = choose(u.x);
        const Vec3f to = ball.center - from;
        const float spread = one_minus_cos(ball, to);
        if (spread >= 2) return warp_sphere(u);
        return normalize(Frame::from_normal(normalize(to)).to_world(warp_cone(u, spread)));
    }
    /// Density of direction samples, 1/sr.
    float direction_pdf(Vec3f from, Vec3f w) const {
        float sum = 0;
        for (const Sphere& ball : balls_) {
            const Vec3f to = ball.center - from;
            const float spread = one_minus_cos(ball, to);
            if (spread >= 2 || is_within(to, w, ball)) sum += warp_cone_pdf(spread);
        }
        return balls_.empty() ? 0 : sum / float(balls_.size());
    }
    /// Samples a point on the disc of a sphere perpendicular to the direction `w`.
    Vec3f disc_point(Vec3f w, Vec2f u) const {
        const Sphere& ball = choose(u.x);
        const Vec2f d = warp_disk(u) * ball.radius;
        return ball.center + Frame::from_normal(w).to_world({d.x, d.y, 0});
    }
    /// Density of disc samples per m2 perpendicular to the ray through a point along `w`.
    float disc_pdf(Vec3f point, Vec3f w) const {
        float sum = 0;
        for (const Sphere& ball : balls_) {
            if (is_within(ball.center - point, w, ball, false))
                sum += 1 / (kPi * ball.radius * ball.radius);
        }
        return balls_.empty() ? 0 : sum / float(balls_.size());
    }

  private:
    const Sphere& choose(float& u) const {
        const float scaled = u * float(balls_.size());
        const std::size_t i = std::min(std::size_t(scaled), balls_.size() - 1);
        u = std::clamp(scaled - float(i), 0.f, kBelowOne);
        return balls_[i];
    }
    /// 1 - cos of the cone that the sphere subtends; 2 from inside.
    static float one_minus_cos(const Sphere& ball, Vec3f to) {
        const float d2 = length_squared(to), r2 = ball.radius * ball.radius;
        return d2 <= r2 ? 2 : one_minus_cos_from_sin2(r2 / d2);
    }
    /// Whether a ray along `w` hits the sphere.
    static bool is_within(Vec3f to, Vec3f w, const Sphere& ball, bool ahead = true) {
        const float along = dot(to, w);
        if (ahead && along <= 0) return false;
        return length_squared(to - w * along) <= ball.radius * ball.radius;
    }

    std::vector<Sphere> balls_;
};

}  // namespace dg
