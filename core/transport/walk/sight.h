// sight.h -- the result of a camera ray: light, coverage, and guides for a denoiser.
#pragma once
#include <array>
#include <cstdint>

#include "math/vec.h"
#include "spectrum/sampled_spectrum.h"

namespace dg {

/// Light in two parts that add up. `shared`: any wavelength of the path could have found it as the hero. `hero`: it
/// lies behind a dispersive interface, where the path follows the hero alone (lane 0, with the share of all four
/// already; see hero_alone()).
struct Radiance {
    Spectrum shared{0.f}, hero{0.f};
    Spectrum sum() const { return shared + hero; }
};

/// The first surface on the way, and guides for a denoiser: the albedo and normal that the camera sees. In mirrors and
/// smooth glass these are from the surfaces behind, each way weighted by its share of light; 0 where there is nothing.
/// The documentation of Open Image Denoise (Albedos, Normals) recommends this.
struct FirstHit {
    bool found = false;
    Vec3f position, normal, albedo;   // m, world; unit
    std::uint32_t instance = 0;
    Vec3f seen_albedo, seen_normal;   // of the first surface that is not smooth, times that share
};

/// Share of a ray's light that an object covers. Without the object, the scene behind would have brought that share.
struct Cover {
    std::uint32_t instance;   // or, from kSpheres on, a sphere light
    float share;
    static constexpr std::uint32_t kSpheres = 0x80000000u;
};

/// The objects that cover the background, seen straight: through clear sheets, and through smooth glass if
/// PathSettings::see_through. The shares add to 1 where nothing of the background is seen. The first kMost objects are
/// kept; the last of them also gets the shares of all others.
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
    /// Adds the share that media cover. They are no objects.
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

/// Radiance along a camera ray, and coverage. In a scene with catchers (catcher/two_worlds.h) `light` is from objects
/// alone. `with` and `without` are from catchers and the background: with the objects in the scene, and without them.
/// Both are for the whole ray, also where an object covers it.
struct Sight {
    Radiance light, with, without;
    Covers covers;
};

}  // namespace dg
