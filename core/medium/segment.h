// segment.h -- a ray segment through a homogeneous medium, at the four wavelengths of a path.
//
// The free-path density depends on the wavelength that draws the distance. Let p_k be the density of the path so far if
// wavelength k had drawn it; `lanes` holds p_k over the mean of all four. A wavelength is chosen in proportion to
// `lanes`, draws the distance, and the sample has the weight f / mean_k(p_k): the balance heuristic over the four
// wavelengths (Wilkie et al. 2014, Hero Wavelength Spectral Sampling, EGSR), which limits weights to 4 in strongly
// coloured media. Choosing a wavelength at each medium gives the same distribution as a single choice for the path.
#pragma once
#include <limits>

#include "medium/medium.h"

namespace dg {

class Segment {
  public:
    /// `length`: m, may be infinite. `hero_only`: the secondary wavelengths are terminated.
    Segment(const MediumAt& medium, float length, Spectrum lanes, bool hero_only)
        : medium_(medium),
          rate_(hero_only ? Spectrum(medium.extinction[0]) : medium.extinction),
          lanes_(lanes),
          length_(length) {
        find_collisions();
    }

    float length() const { return length_; }
    const MediumAt& medium() const { return medium_; }
    /// Probability of a collision before the end.
    float collides() const { return (lanes_ * met_).average(); }

    /// Samples the distance to a collision, m, given a collision before the end; requires collides() > 0. `u` in [0,
    /// 1).
    float free_collision(float u) const;
    /// Samples a distance like free_collision(), but chooses the wavelength without regard to its collision
    /// probability.
    float collision(float u) const;
    /// Density of collision() at a distance, 1/m: the mean over the wavelengths that may have drawn it.
    float collision_density(float t) const { return (colliding_ * densities(t)).average(); }

    /// Transmittance to a distance.
    Spectrum transmittance_to(float t) const { return transmittance(medium_.extinction, t); }
    /// Radiance emitted along the whole segment.
    Spectrum emitted() const;

    /// Throughput factor and new lanes of a path that passes the segment or is scattered at a distance. Absorption is
    /// part of the weight; a weight of 0 ends the path. `drawn`: fraction of collisions at which the path is scattered;
    /// at the rest it passes.
    struct Onward {
        Spectrum weight, lanes;
    };
    Onward passed(float drawn = 1) const {
        const Spectrum density = drawn < 1 ? Spectrum(1.f) - met_ * drawn : transmittance(rate_, length_);
        return onward(transmittance_to(length_), density);
    }
    Onward scattered(float t, float drawn = 1) const {
        Onward to = onward(medium_.scattering * transmittance_to(t), densities(t));
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
    Spectrum rate_, lanes_, met_{0.f};   // met: probability of a collision before the end, per wavelength
    Spectrum colliding_{0.f};            // shares of wavelengths that can collide, over met
    float length_;
};

}  // namespace dg
