// environment_pose.cpp -- an environment with animated rotation and strength: tables are in the frame of the picture,
// and directions are rotated to it.
#include "light/emitter_check.h"
#include "light/environment.h"

namespace dg {
namespace {

Vec3f turned_about_y(Vec3f d, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

}  // namespace

EnvironmentPose blend(const EnvironmentPose& a, const EnvironmentPose& b, float share) {
    return {a.strength * (1 - share) + b.strength * share,
            a.turn * (1 - share) + b.turn * share};
}

Environment Environment::posed(Keyed<EnvironmentPose> poses) const {
    Rgb most{0, 0, 0};
    for (const EnvironmentPose& pose : poses.values) {
        check_color("environment", "strength", pose.strength);
        check_finite("environment", "turn", {pose.turn, 0, 0});
        for (int i = 0; i < 3; ++i) most[i] = std::max(most[i], pose.strength[i]);
    }
    Environment e = *this;
    e.mean_luminance_ *= dg::luminance(most);
    e.poses_ = std::make_shared<const Keyed<EnvironmentPose>>(std::move(poses));
    return e;
}

/// Rotates about +y by the turn at that time, or back (sign -1).
Vec3f Environment::turned(Vec3f direction, float time, float sign) const {
    return poses_ ? turned_about_y(direction, sign * poses_->at(time).turn) : direction;
}

Rgb Environment::luminance_posed(Vec3f direction, float time) const {
    const EnvironmentPose now = poses_->at(time);
    return luminance_within(turned_about_y(direction, -now.turn)) * now.strength;
}

Environment::Sample Environment::sample_posed(Vec2f u, float time) const {
    const EnvironmentPose now = poses_->at(time);
    Sample s = sample_within(u);
    s.direction = normalize(turned_about_y(s.direction, now.turn));
    s.luminance *= dg::luminance(now.strength);
    return s;
}

float Environment::pdf_posed(Vec3f direction, float time) const {
    return pdf_within(turned_about_y(direction, -poses_->at(time).turn));
}

Environment::Lookup Environment::lookup(Vec3f direction, float time) const {
    if (!poses_) return lookup_within(direction);
    const EnvironmentPose now = poses_->at(time);
    Lookup found = lookup_within(turned_about_y(direction, -now.turn));
    found.luminance = found.luminance * now.strength;
    return found;
}

}  // namespace dg
