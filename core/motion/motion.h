// motion.h -- transform over time with any number of keys.
//
// Interpolation of matrices between two keys (docs/motion.md describes where each fails):
//   linear      by components: points move straight; rotations shrink the object
//   twist       rigid keys: single axis, constant angular speed; straight translation
//   slerp       translation, rotation and scale along the local axes; no shear
//   decomposed  M = T R S with the closest rotation R and a symmetric stretch S: any keys
// Two keys never rotate by more than 180 degrees; `Spin` makes any number of turns. Sources: the
// UCSD lecture on cameras (linear, twist); Shoemake and Duff 1992, Matrix Animation and Polar
// Decomposition, Graphics Interface.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "math/quaternion.h"
#include "math/transform.h"

namespace dg {

enum class Interpolation { linear, twist, slerp, decomposed };

/// Rotation about an axis through a point, both in the local space of the motion.
struct Spin {
    Vec3d axis{0, 1, 0};                // unit
    double revolutions_per_second = 0;  // right-handed
    Vec3d center{0, 0, 0};
    double time = 0;                    // s, time of zero rotation
};

class Motion {
  public:
    /// Constant transform.
    Motion(const Affine3d& still = {}) : still_(still) {}  // NOLINT: a transform is a motion

    /// Keys at ascending `times` (s); two keys at the same time are a jump. `pivot`, in local
    /// space, is the point that moves straight between keys (default: the origin). Singular keys,
    /// and pairs of keys of opposite handedness, are interpolated linearly. Throws Error for no
    /// keys, descending times, non-finite numbers, twist of non-rigid keys, and slerp of keys with
    /// shear.
    static Motion keys(std::span<const double> times, std::span<const Affine3d> keys,
                       Interpolation interpolation, Vec3d pivot = {});

    /// This motion, applied after the rotation `spin`.
    Motion spinning(const Spin& spin) const;

    /// This motion between frames with other origins, both along the axes of the frames before: `world_origin` in the
    /// world, `local_origin` in the local space. Exact for shifts that double represents.
    Motion relative_to(Vec3d world_origin, Vec3d local_origin = {}) const;

    bool moves() const { return track_ != nullptr; }
    Affine3d at(double time) const { return track_ ? track_->at(time) : still_; }

    /// This motion with time remapped so that `open` is 0 and `close` is 1; constant if it does not
    /// move in between.
    Motion over(double open, double close) const;

    /// Rotation about a fixed axis: M(angle) = mean + cos(angle) cosine + sin(angle) sine.
    struct Turn {
        Affine3d mean{}, cosine{}, sine{};
        Affine3d at(double angle) const;
    };
    /// Interpolation between two keys: M(s) = T R S about the pivot, or M0 + s dM.
    struct Segment {
        Affine3d first{};        // the first key
        bool turns = false;      // false: linear
        bool stretches = false;  // rotation with a changing S
        /// Difference to the next key; for rotations: of S and of the pivot's position.
        Affine3d change{{}, {}, {}, {}};
        Quaterniond rotation{};  // R at the key
        Vec3d axis{0, 0, 1};     // axis of the rotation to the next key; angle in rad, 0 .. pi
        double angle = 0;
        Affine3d stretch{};      // S at the key; linear part only
        Turn turn{};             // R S about the pivot; R alone if S changes

        Affine3d at(double s, Vec3d pivot) const;
        Affine3d stretch_at(double s) const;
    };
    struct Track {
        std::vector<double> times;
        std::vector<Segment> segments;  // one per time; the last is constant
        Vec3d pivot{};
        Spin spin;
        Turn spun_first{};  // the first key with the spin

        Affine3d at(double time) const;
        bool spins() const { return spin.revolutions_per_second != 0; }
        Affine3d spun(double time) const;  // rotation of the spin alone
        double spin_angle(double time) const;
    };
    const Track* track() const { return track_.get(); }  // null: constant

  private:
    explicit Motion(Track track);
    Track track_or_still() const;

    Affine3d still_;
    std::shared_ptr<const Track> track_;  // shared by copies
};

}  // namespace dg
