// light_profile.h -- how a lamp's light depends on direction: photometric tables, cones and focus, multiplied.
//
// Directions are in the lamp's own frame, in which it shines along -z. theta is the angle from -z, the nadir of a
// lamp that hangs; phi goes from +x toward +y, counter-clockwise for who looks along -z. Source: IES LM-63-2019,
// type C photometry.
#pragma once
#include <cstdint>
#include <vector>

#include "math/quaternion.h"
#include "math/transform.h"
#include "spectrum/spectrum.h"

namespace dg {

/// Nothing leaves farther from the axis than `angle`; from (1 - softness) of it on, light falls smoothly to 0.
/// Source: UsdLux ShapingAPI (OpenUSD 25.05 and later), shaping:cone:angle and :softness.
struct ProfileCone {
    float angle;      // rad, (0, pi]
    float softness;   // 0 .. 1

    float at(float theta) const;
};

/// |cos theta|^exponent, and `tint` in place of what that takes away. Source: UsdLux ShapingAPI, shaping:focus and
/// :focusTint.
struct ProfileFocus {
    float exponent;   // >= 0
    Rgb tint;

    Rgb at(float cosine) const;
};

/// Values at angles, bilinear in between and 0 beyond the first and last theta.
struct ProfileTable {
    std::vector<float> theta;    // rad, rising, within 0 .. pi
    std::vector<float> phi;      // rad, rising from 0 to 2 pi; or one, of a table that does not depend on it
    std::vector<float> values;   // theta.size() rows of phi.size() values

    float at(float theta, float phi) const;
};

/// Parts whose factors are multiplied, and a number.
struct ProfileParts {
    float scale = 1;
    std::vector<ProfileCone> cones{};
    std::vector<ProfileFocus> focuses{};
    std::vector<ProfileTable> tables{};
};

class LightProfile {
  public:
    /// Throws Error that names part and value.
    explicit LightProfile(ProfileParts parts);

    /// Factor on the light that leaves along `local` (unit, in the lamp's frame).
    Rgb at(Vec3f local) const;

    /// Largest factor of all channels and directions, at the angles of the parts; of huge tables an upper bound.
    float peak() const { return peak_; }
    float spread() const { return spread_; }   // rad from the axis: beyond there is no light; pi: there may be
    Rgb mean() const { return mean_; }         // over all directions
    /// Power that is left of a surface that shines evenly and faces along -z.
    Rgb facing_mean() const { return facing_mean_; }

  private:
    Rgb at(float theta, float phi) const;
    std::vector<double> theta_knots() const;
    std::vector<double> phi_knots(std::size_t thetas) const;
    float bound() const;
    void measure();

    ProfileParts parts_;
    float peak_ = 0, spread_ = kPi;
    Rgb mean_{}, facing_mean_{};
};

/// Axes of a lamp in the world, unit and at right angles: its z, its x as far as it is at right angles to z, and y on
/// that side on which the transform has it. So scale and shear of a lamp do not change its profile.
struct LampAxes {
    Vec3f x, y, z;

    explicit LampAxes(const Affine3d& world_from_local);
    LampAxes(const Quaternionf& rotation, bool mirrored);
    Vec3f local(Vec3f world) const { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

/// How a lamp with a profile stands in the world.
struct LampShape {
    std::int32_t profile = -1;   // index; -1: it shines alike in all directions
    Quaternionf rotation{};      // world from local
    float spread = kPi;   // of the profile
    bool mirrored = false;       // y points the other way

    LampShape() = default;
    LampShape(std::int32_t profile, const Affine3d& world_from_local);
    bool used() const { return profile >= 0; }
    Vec3f local(Vec3f world) const { return LampAxes(rotation, mirrored).local(world); }
    /// Where its light goes at most.
    Vec3f axis() const { return rotation.rotate({0, 0, -1}); }
};

/// `share` of the way from a to b, the profile and side of a.
LampShape blend(const LampShape& a, const LampShape& b, float share);

}  // namespace dg
