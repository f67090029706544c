// segment.h -- a straight way through an even medium, at the four wavelengths of a path.
//
// A path may be drawn by any of its wavelengths, each of which would have chosen other distances. With p_k the density
// of the path so far had wavelength k drawn it, `lanes` has p_k over their mean. A distance is drawn by a wavelength
// chosen by these shares, and counts f / mean_k(p_k): the balance heuristic over the four (Wilkie et al. 2014, Hero
// Wavelength Spectral Sampling, EGSR), so that no weight exceeds 4 however colourful the medium is. The choice is made
// anew at each medium, which has the same law as one choice for the path, and depends on nothing but the path.
#pragma once
#include <limits>

#include "medium/medium.h"

namespace dg {

class Segment {
  public:
    /// `length` m, or infinite; `hero_only`: the other wavelengths have ended.
    Segment(const MediumAt& medium, float length, Spectrum lanes, bool hero_only)
        : medium_(medium),
          rate_(hero_only ? Spectrum(medium.extinction[0]) : medium.extinction),
          lanes_(lanes),
          length_(length) {
        find_collisions();
    }

    float length() const { return length_; }
    const MediumAt& medium() const { return medium_; }
    /// Chance that the path collides before the end.
    float collides() const { return (lanes_ * met_).average(); }

    /// Distance to a collision, m, of a path that collides before the end; collides() > 0. `u` in [0, 1).
    float free_collision(float u) const;
    /// Distance to a collision before the end, by wavelengths that count as if each collided there for sure.
    float collision(float u) const;
    /// Density of collision() at a distance, per m: the mean over the wavelengths by which it may have been drawn.
    float collision_density(float t) const { return (colliding_ * densities(t)).average(); }

    /// Share of light that reaches a distance.
    Spectrum left(float t) const { return transmittance(medium_.extinction, t); }
    /// Radiance that the whole way adds.
    Spectrum emitted() const;

    /// A path that passes, or collides at a distance: factor on what it carries, and its lanes from there on.
    /// Every collision scatters; what is absorbed there is a factor. A weight of 0: it carries nothing. `drawn`: the
    /// share of those that collide before the end which is scattered; the rest passes.
    struct Onward {
        Spectrum weight, lanes;
    };
    Onward passed(float drawn = 1) const {
        const Spectrum density = drawn < 1 ? Spectrum(1.f) - met_ * drawn : transmittance(rate_, length_);
        return onward(left(length_), density);
    }
    Onward scattered(float t, float drawn = 1) const {
        Onward to = onward(medium_.scattering * left(t), densities(t));
        to.weight *= 1 / drawn;
        return to;
    }

  private:
    Onward onward(Spectrum value, Spectrum density) const;
    Spectrum densities(float t) const { return rate_ * transmittance(rate_, t); }
    void find_collisions();
    int choose(Spectrum shares, float& u) const;
    float before_end(int k, float u) const;

    MediumAt medium_;
    Spectrum rate_, lanes_, met_{0.f};   // met: chance of a collision before the end, by wavelength
    Spectrum colliding_{0.f};            // shares of those that collide at all, over met
    float length_;
};

}  // namespace dg
