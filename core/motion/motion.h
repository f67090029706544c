// motion.h -- a transform over time: the lecture's MotionObject, with any number of keys.
//
// How matrices are interpolated between two keys, and where each way fails, is told in docs/motion.md:
//   linear      components, one by one: points go straight; a turn shrinks what it turns
//   twist       rigid keys: one axis, constant angular speed; the translation goes straight
//   slerp       translation, rotation and a scale along the mesh's own axes; no shear
//   decomposed  M = T R S with the closest rotation R and a symmetric stretch S: any keys
// Two keys never describe more than 180 degrees; `Spin` turns any number of times.
// Sources: the UCSD lecture on cameras (linear, twist); Shoemake and Duff 1992, Matrix Animation and
// Polar Decomposition, Graphics Interface.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "math/quaternion.h"
#include "math/transform.h"

namespace dg {

enum class Interpolation { linear, twist, slerp, decomposed };

/// Turns about an axis through a point, both in the space that the motion transforms from.
struct Spin {
    Vec3d axis{0, 1, 0};                // unit
    double revolutions_per_second = 0;  // right-handed
    Vec3d center{0, 0, 0};
    double time = 0;                    // s, at which it has not turned
};

class Motion {
  public:
    /// Stands still.
    Motion(const Affine3d& still = {}) : still_(still) {}  // NOLINT: a transform is a motion

    /// Keys at `times` (s) that do not fall; two of one time are a jump. `pivot`, in the space that is
    /// transformed from, is the point whose path is straight between keys (without one: the origin).
    /// Keys that have no inverse, and neighbours of which one mirrors, are interpolated linearly.
    /// Throws Error: no keys, times that fall, numbers that are not finite, twist of keys that are not
    /// rigid, slerp of keys with shear.
    static Motion keys(std::span<const double> times, std::span<const Affine3d> keys,
                       Interpolation interpolation, Vec3d pivot = {});

    /// The same, after turning as `spin` says.
    Motion spinning(const Spin& spin) const;

    bool moves() const { return track_ != nullptr; }
    Affine3d at(double time) const { return track_ ? track_->at(time) : still_; }

    /// This motion with `open` as time 0 and `close` as time 1; it stands still if it does not move in
    /// between.
    Motion over(double open, double close) const;

    /// Turn about an axis at rest: M(angle) = mean + cos(angle) cosine + sin(angle) sine.
    struct Turn {
        Affine3d mean{}, cosine{}, sine{};
        Affine3d at(double angle) const;
    };
    /// From one key to the next: M(s) = T R S about the pivot, or M0 + s dM.
    struct Segment {
        Affine3d first{};        // the key, as it was given
        bool turns = false;      // else linear
        bool stretches = false;  // turns, and S changes
        /// Change added until the next key; if it turns, to S and to the place of the pivot.
        Affine3d change{{}, {}, {}, {}};
        Quaterniond rotation{};  // R at the key
        Vec3d axis{0, 0, 1};     // of the turn until the next key; angle in rad, 0 .. pi
        double angle = 0;
        Affine3d stretch{};      // S at the key; linear part only
        Turn turn{};             // R S about the pivot; R alone where S changes

        Affine3d at(double s, Vec3d pivot) const;
        Affine3d stretch_at(double s) const;
    };
    struct Track {
        std::vector<double> times;
        std::vector<Segment> segments;  // one per time; the last one is held
        Vec3d pivot{};
        Spin spin;
        Turn spun_first{};  // the first key, spinning

        Affine3d at(double time) const;
        bool spins() const { return spin.revolutions_per_second != 0; }
        Affine3d spun(double time) const;  // the spin alone
        double spin_angle(double time) const;
    };
    const Track* track() const { return track_.get(); }  // null: stands still

  private:
    explicit Motion(Track track);
    Track track_or_still() const;

    Affine3d still_;
    std::shared_ptr<const Track> track_;  // copies share it
};

}  // namespace dg
