// emission_aim.h -- balls that light is sent to on purpose: what bends or mirrors light is often small,
// and what it does with the light of a lamp (a caustic) is found by light paths that meet it.
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

    /// A direction from a point to one of the balls, all of them alike; u.x also chooses which.
    Vec3f direction(Vec3f from, Vec2f u) const {
        const Sphere& ball = choose(u.x);
        const Vec3f to = ball.center - from;
        const float spread = one_minus_cos(ball, to);
        if (spread >= 2) return warp_sphere(u);
        return normalize(Frame::from_normal(normalize(to)).to_world(warp_cone(u, spread)));
    }
    /// Its density, per sr.
    float direction_pdf(Vec3f from, Vec3f w) const {
        float sum = 0;
        for (const Sphere& ball : balls_) {
            const Vec3f to = ball.center - from;
            const float spread = one_minus_cos(ball, to);
            if (spread >= 2 || is_within(to, w, ball)) sum += warp_cone_pdf(spread);
        }
        return balls_.empty() ? 0 : sum / float(balls_.size());
    }
    /// A point of the disc that one of the balls shows to light along `w`.
    Vec3f disc_point(Vec3f w, Vec2f u) const {
        const Sphere& ball = choose(u.x);
        const Vec2f d = warp_disk(u) * ball.radius;
        return ball.center + Frame::from_normal(w).to_world({d.x, d.y, 0});
    }
    /// Its density per m2 across the ray that goes along `w` through a point.
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
    /// 1 - cos of the cone that the ball fills; 2 from inside.
    static float one_minus_cos(const Sphere& ball, Vec3f to) {
        const float d2 = length_squared(to), r2 = ball.radius * ball.radius;
        return d2 <= r2 ? 2 : one_minus_cos_from_sin2(r2 / d2);
    }
    /// Whether a line along `w` meets the ball (ahead).
    static bool is_within(Vec3f to, Vec3f w, const Sphere& ball, bool ahead = true) {
        const float along = dot(to, w);
        if (ahead && along <= 0) return false;
        return length_squared(to - w * along) <= ball.radius * ball.radius;
    }

    std::vector<Sphere> balls_;
};

}  // namespace dg
