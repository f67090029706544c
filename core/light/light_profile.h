// light_profile.h -- directional distribution of a lamp: the product of photometric tables, cones and focus.
//
// Directions are in the lamp's frame, with emission along -z. theta is the angle from -z, the nadir of a hanging lamp;
// phi goes from +x toward +y, counter-clockwise when looking along -z. Source: IES LM-63-2019, type C photometry.
#pragma once
#include <cstdint>
#include <vector>

#include "math/quaternion.h"
#include "math/transform.h"
#include "spectrum/spectrum.h"

namespace dg {

/// Emission is 0 outside `angle` from the axis, and falls smoothly to 0 from (1 - softness) `angle` on.
/// Source: UsdLux ShapingAPI (OpenUSD 25.05 and later), shaping:cone:angle and :softness.
struct ProfileCone {
    float angle;      // rad, (0, pi]
    float softness;   // 0 .. 1

    float at(float theta) const;
};

/// |cos theta|^exponent, with `tint` for the removed light. Source: UsdLux ShapingAPI, shaping:focus and :focusTint.
struct ProfileFocus {
    float exponent;   // >= 0
    Rgb tint;

    Rgb at(float cosine) const;
};

/// Table of values by angle, with bilinear interpolation, and 0 outside the range of theta.
struct ProfileTable {
    std::vector<float> theta;    // rad, ascending, in 0 .. pi
    std::vector<float> phi;      // rad, ascending from 0 to 2 pi; or a single value if the table does not depend on phi
    std::vector<float> values;   // theta.size() rows of phi.size() values

    float at(float theta, float phi) const;
};

/// Factors of a profile, and a scale.
struct ProfileParts {
    float scale = 1;
    std::vector<ProfileCone> cones{};
    std::vector<ProfileFocus> focuses{};
    std::vector<ProfileTable> tables{};
};

class LightProfile {
  public:
    /// Throws Error that names the factor and the value.
    explicit LightProfile(ProfileParts parts);

    /// Factor on emission along `local` (unit, in the lamp's frame).
    Rgb at(Vec3f local) const;

    /// Largest factor over channels and directions, at the knots of the parts; an upper bound for huge tables.
    float peak() const { return peak_; }
    float spread() const { return spread_; }   // rad from the axis: no emission outside; pi: unlimited
    Rgb mean() const { return mean_; }         // over all directions
    /// Factor on the power of a uniform flat emitter that faces -z.
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

/// Orthonormal axes of a lamp in the world: z, x orthogonalized to z, and y with the handedness of the transform. Scale
/// and shear of a lamp do not change its profile.
struct LampAxes {
    Vec3f x, y, z;

    explicit LampAxes(const Affine3d& world_from_local);
    LampAxes(const Quaternionf& rotation, bool mirrored);
    Vec3f local(Vec3f world) const { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

/// Placement of a lamp's profile in the world.
struct LampShape {
    std::int32_t profile = -1;   // index; -1: none
    Quaternionf rotation{};      // world from local
    float spread = kPi;   // of the profile
    bool mirrored = false;       // y is flipped

    LampShape() = default;
    LampShape(std::int32_t profile, const Affine3d& world_from_local);
    bool used() const { return profile >= 0; }
    Vec3f local(Vec3f world) const { return LampAxes(rotation, mirrored).local(world); }
    /// Axis of its emission cone.
    Vec3f axis() const { return rotation.rotate({0, 0, -1}); }
};

/// Interpolates rotations; profile and handedness are taken from a.
LampShape blend(const LampShape& a, const LampShape& b, float share);

}  // namespace dg
