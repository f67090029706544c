// path.h -- radiance along a ray. Knows neither camera nor film, so it can be held against a furnace.
#pragma once
#include <array>

#include "geometry/ray.h"
#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/plate_light.h"

namespace dg {

/// Behind everything, where the lens looks past it: the environment, or nothing, for a plate to come there. Light from
/// there is the environment's in either case.
enum class Background { environment, transparent };

struct PathSettings {
    int max_depth = 16;      // surface vertices
    int roulette_depth = 2;  // vertices before Russian roulette of weak paths
    int splits = 2;          // smooth clear interfaces, seen from where the path starts, of which it takes both ways
    enum class Strategy { mis, light, bsdf } strategy = Strategy::mis;   // light, bsdf: for tests
    bool caustics = true;    // with what mirrors and smooth glass throw on rough surfaces
    bool straight = true;    // with what emitters send straight along the ray, through clear sheets too
    Background background = Background::environment;
    bool see_through = false;   // smooth glass lets the background pass unbent; false: it covers it with what it shows
    /// How the light of lamps is sampled along a way through a medium (path_media-inl.h); the latter for tests.
    enum class Distances { both, equiangular, free } distances = Distances::both;
    const PlateLight* plate = nullptr;   // light of the set as objects see it; null: that of its materials
};

/// Light in two parts that add up: what any wavelength of the path could have found as its hero, and
/// what was found behind a dispersive interface, where the path went the way of its hero alone (lane 0,
/// with the share of all four already; see hero_alone()).
struct Radiance {
    Spectrum shared{0.f}, hero{0.f};
    Spectrum sum() const { return shared + hero; }
};

/// The first surface on the way, and guides for a denoiser: albedo and normal of what is seen in it. Mirrors and smooth
/// glass show what lies behind them, each way with the share of light that takes it; nothing is 0. So the documentation
/// of Open Image Denoise (Albedos, Normals) recommends it.
struct FirstHit {
    bool found = false;
    Vec3f position, normal, albedo;   // m, world; unit
    std::uint32_t instance = 0;
    Vec3f seen_albedo, seen_normal;   // of the first surface that is not smooth, times that share
};

/// Share of a ray's light that one object covers: what lies behind it would have brought as much.
struct Cover {
    std::uint32_t instance;   // or, from kSpheres on, a sphere light
    float share;
    static constexpr std::uint32_t kSpheres = 0x80000000u;
};

/// The objects that cover what lies behind them, seen straight: through clear sheets, and through smooth glass if
/// PathSettings::see_through. The shares are 1 together where nothing behind is seen; the first kMost have theirs.
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
    /// Share that media cover, which are no objects.
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

/// Radiance along a camera ray, and what it covers. In a scene with catchers `light` is that of the objects alone;
/// `with` is what catchers and the background send past them, with the objects in the scene, and `without` what they
/// send where there are none: of the whole ray, also where an object covers it.
struct Sight {
    Radiance light, with, without;
    Covers covers;
};

class FirstRay;   // first_ray.h

/// Radiance that arrives along `ray`, by path tracing with next-event estimation and multiple importance sampling. At
/// the first smooth clear interfaces that it sees, a path goes both ways. `hit`, if given, receives the first surface;
/// `first`, if given, says which share of what emitters send straight along the ray is left to this path.
Radiance radiance(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
                  const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count,
                  const FirstRay* first = nullptr);

/// The same with coverage, in parts where the scene has catchers. Then light paths must not be in use.
Sight look(const Scene& scene, Ray ray, const Wavelengths& wavelengths, PathSampler& sampler,
           const PathSettings& settings, FirstHit* hit, std::uint64_t* ray_count, const FirstRay* first = nullptr);

}  // namespace dg
