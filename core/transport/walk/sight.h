// sight.h -- the result of a camera ray: light, coverage, and guides for a denoiser.
#pragma once
#include <array>
#include <cstdint>

#include "math/vec.h"
#include "spectrum/sampled_spectrum.h"

namespace dg {

/// Radiance as a sum of two parts. `any_hero`: light that any wavelength of the path could have found as the hero.
/// `hero`: light behind a dispersive interface, where only the path's own hero continues (lane 0, already scaled by
/// four; see hero_alone()). Reprojection through a dispersive lens (render/dispersion.h) weighs the two parts
/// differently.
struct Radiance {
    Spectrum any_hero{0.f}, hero{0.f};
    Spectrum sum() const { return any_hero + hero; }
};

/// The first surface along a camera ray, and the denoiser's guides: albedo and normal. Mirrors and smooth glass show
/// the guides of the surfaces that they reflect and transmit, each weighted by the throughput; 0 for the background.
/// The documentation of Open Image Denoise (Albedos, Normals) recommends this.
struct FirstHit {
    bool found = false;
    Vec3f position, normal, albedo;   // m, world; unit
    std::uint32_t instance = 0;
    Vec3f guide_albedo, guide_normal;   // guides: sums over branches, of the first rough surface times the throughput
};

/// Coverage of an object: the fraction of a ray's light that it blocks from the scene behind it.
struct Cover {
    std::uint32_t instance;   // or, from kSpheres on, a sphere light
    float share;
    static constexpr std::uint32_t kSpheres = 0x80000000u;
};

/// Coverage of the background by objects along the unrefracted ray: through clear sheets, and through smooth glass if
/// PathSettings::see_through. The shares add to 1 where the background is not visible. Only the first kMost objects are
/// stored; the last of them accumulates the shares of all further objects.
class Covers {
  public:
    static constexpr std::size_t kMost = 4;
    void add(std::uint32_t instance, float share) {
        std::size_t i = 0;
        while (i < count_ && all_[i].instance != instance) ++i;
        if (i == count_ && count_ == kMost) i = kMost - 1;
        else if (i == count_) all_[count_++] = {instance, 0};
        all_[i].share += share;
    }
    const Cover* begin() const { return all_.data(); }
    const Cover* end() const { return all_.data() + count_; }
    /// Adds the coverage of media, which belongs to no object.
    void add_veil(float share) { veil_ += share; }
    float sum() const {
        float sum = veil_;
        for (const Cover& c : *this) sum += c.share;
        return sum;
    }

  private:
    std::array<Cover, kMost> all_;
    std::size_t count_ = 0;
    float veil_ = 0;
};

/// Radiance and coverage of a camera ray. In a scene with catchers (catcher/two_worlds.h) `light` is the radiance of
/// objects; `with_objects` and `without_objects` are the radiance of catchers and background, in the scene with the
/// objects and in the scene without them. `light` + `with_objects` is the radiance of the full scene. `without_objects`
/// includes catchers behind an object that covers them, as if it were absent.
struct Sight {
    Radiance light, with_objects, without_objects;
    Covers covers;
};

}  // namespace dg
