// light.h -- emitters: sampling, densities, emission. Independent of the scene. Photometric units: colours are Rgb of
// D65-shaped spectra; intensity cd, illuminance lux, luminance cd/m2.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "geometry/mesh.h"
#include "light/environment.h"
#include "light/light_profile.h"
#include "light/light_tree.h"
#include "math/distribution.h"
#include "math/transform.h"
#include "motion/keyed.h"
#include "spectrum/wavelengths.h"

namespace dg {

struct PointLight {
    Vec3f position;  // m
    Rgb intensity;   // cd
    float range =
        std::numeric_limits<float>::infinity();  // m; glTF window (KHR_lights_punctual)
    LampShape lamp{};
};
struct SpotLight {
    Vec3f position;                  // m
    Vec3f direction;                 // unit, axis of emission
    Rgb intensity;                   // cd, on the axis
    float inner_angle, outer_angle;  // rad, half angles
    float range = std::numeric_limits<float>::infinity();
};
/// Light from infinity: parallel, or from a uniform disc that only light sampling finds (emitter.h).
struct DirectionalLight {
    Vec3f direction;  // unit, direction of propagation; for a disc, from its center
    Rgb illuminance;  // lux, on a facing surface
    float angle = 0;  // rad, angular diameter of the disc; 0: parallel
};
/// A spherical emitter, uniform or with a profile; rays can hit it (Intersector sphere `sphere`).
struct SphereLight {
    Sphere shape;
    Rgb luminance;  // cd/m2
    LampShape lamp{};
};
/// An emissive triangle in world space.
struct TriangleLight {
    Vec3f a, b, c;
    Rgb mean_luminance;  // cd/m2, mean over the triangle, only for
                         // choosing lights
    std::uint32_t instance, primitive;
    bool two_sided;
    bool mirrored = false;  // a, b, c are clockwise seen from the front (instance with
                            // determinant < 0)
    bool even =
        false;  // emission is uniform, mean_luminance on each emissive side
};
using Light =
    std::variant<PointLight, SpotLight, DirectionalLight, SphereLight, TriangleLight>;

/// Profile placement of kinds that may have a profile; null for other kinds.
const LampShape* lamp_of(const Light& light);
LampShape* lamp_of(Light& light);

/// Motion of lights while the shutter is open (fractions of the scene's interval), by index; other lights are static.
/// See light_keys.h.
struct LightMotion {
    std::map<std::uint32_t, Keyed<Light>> keys;  // each of a single kind; no triangles
    /// Moving triangles, with bounds over all times.
    std::map<std::uint32_t, LightBounds> triangles;
    /// Moves a triangle to its position at a time; false while it is hidden.
    std::function<bool(TriangleLight&, float time)> place;
};

/// Profiles that the lights of a scene refer to by index.
struct LightProfiles {
    std::vector<std::shared_ptr<const LightProfile>> list{};
    std::vector<std::int32_t> of_instance{};   // profile of an instance's triangle lights; -1: none. Empty: no profiles
};

struct LightSample {
    Vec3f wi;           // unit, toward the light
    float distance;     // m; infinity for directional and environment
    Spectrum radiance;  // incident radiance; for a delta light the incident irradiance on
                        // a facing surface
    float pdf;  // 1/sr, including the choice of the light; for a delta light, the probability
                // of the choice
    bool delta;  // only light sampling finds it: it has no area, or is the disc of a sun
    /// Index in lights(), or kEnvironment; for a triangle also the barycentrics of the point (weights of its second and
    /// third corner).
    std::int32_t light = -1;
    Vec2f barycentric;
    /// Non-uniform triangle, or picture of a sky: `radiance` is an estimate, for choosing among samples,
    /// and Scene::radiance() evaluates the emission at the point.
    bool uneven = false;
    float error = 0;  // m: error bound of the distance at which a ray along wi hits the lamp
};

struct TriangleSampler;
struct LightSegment;
struct EmitterSample;

/// Choice among lights with a position: by the tree; by power alone or uniformly, to measure the benefit of the tree.
enum class LightChoice { tree, power, even };

/// Density of samples of an environment's picture: by luminance; or compensated for MIS with BSDF sampling, which is
/// better where both are used at each vertex.
enum class SkyDensity { luminance, compensated };

/// All lights of a scene, with a distribution for choosing a light at a point: by the estimated illuminance of each
/// light, which works for huge scenes and for near lamps. Lights from infinity (directional, environment) form one
/// group, the rest a LightTree. Probabilities do not depend on time: they use bounds of position and brightness over
/// all times. Samples are of the light at the given time.
class LightSet {
  public:
    LightSet();
    ~LightSet();
    LightSet(LightSet&&) noexcept;
    LightSet& operator=(LightSet&&) noexcept;
    /// Throws Error that names light and value: for non-finite values, a negative colour, a zero direction, a radius or
    /// range that is not positive, or spot angles in the wrong order.
    LightSet(std::vector<Light> lights, std::optional<Environment> environment,
             LightChoice choice = LightChoice::tree, LightMotion motion = {}, LightProfiles profiles = {},
             SkyDensity sky = SkyDensity::luminance);

    bool empty() const { return tree_.empty() && infinite_.empty(); }
    /// Samples a light. If LightSample::uneven, its radiance is an estimate. Empty if the chosen light cannot
    /// illuminate the position.
    std::optional<LightSample> sample(float u_select, Vec2f u, Vec3f position, float time,
                                      const Wavelengths& wavelengths) const;
    static constexpr std::size_t kMostSamples = LightTree::kMostAtOnce;
    /// Draws several stratified samples of the distribution of sample(); pdf 0 for samples without light.
    void sample_several(float u_select, Vec2f u, Vec3f position, float time, const Wavelengths& wavelengths,
                        std::span<LightSample> found) const;
    /// Chooses a light for a segment in a medium, for sampling from any point of the segment: its index, or
    /// kEnvironment, and its probability. Empty if no light reaches the segment.
    struct Choice {
        std::int32_t light;
        float probability;
    };
    std::optional<Choice> choose(float u, const LightSegment& segment) const;
    /// Probability with which sample() chooses a light.
    float choice_probability(std::int32_t light, Vec3f position) const;
    /// Samples a given light like sample(); its pdf excludes the choice.
    std::optional<LightSample> sample_one(std::int32_t light, Vec2f u, Vec3f position, float time,
                                          const Wavelengths& wavelengths) const;
    /// The point of a light that sample_one() returns for the same u, or its center; empty for lights at infinity.
    struct Place {
        Vec3f position;
        Vec3f normal;   // of any length: emits only in front of its plane; zero: emits to all sides
    };
    std::optional<Place> place_of(std::int32_t light, Vec2f u, float time) const;
    /// Estimated unoccluded illuminance by all lights at a point, lux, as used for choosing a light.
    float illuminance(Vec3f position) const {
        return infinite_illuminance_ + (tree_.empty() ? 0 : tree_.importance(position));
    }
    /// Number of lights to choose from.
    std::size_t choices() const { return tree_.size() + infinite_lights_.size(); }
    /// Density (1/sr, including the choice of the light) with which sample() returns the direction from `position` that
    /// hits this triangle at the distance `t` m with |cos| at the light. 0 for triangles that are not lights. Must be
    /// called only for emissive sides. `position` must be the argument of sample(), since the choice of the light
    /// depends on it.
    float pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float t,
                       float cos_light, Vec3f position, float time) const;
    float pdf_sphere(std::uint32_t sphere, Vec3f position, float time) const;
    /// Density of environment samples; 0 for a uniform environment, which is left to BSDF sampling.
    float pdf_environment(Vec3f direction, Vec3f position, float time) const;
    /// LightSample::pdf with which sample() returns this light (or kEnvironment) along `wi` at `distance`.
    float pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance, float time) const;
    /// Radiance for a ray that hit sphere light `sphere`, emitted in the direction `away`, or for a ray that left the
    /// scene.
    Spectrum sphere_radiance(std::uint32_t sphere, Vec3f away, float time,
                             const Wavelengths& wavelengths) const;
    Spectrum environment_radiance(Vec3f direction, float time,
                                  const Wavelengths& wavelengths) const;
    /// environment_radiance() and pdf_environment() in one look-up. There must be an environment.
    struct SkyLookup {
        Spectrum radiance;
        float pdf;
    };
    SkyLookup lookup_environment(Vec3f direction, Vec3f position, float time, const Wavelengths& wavelengths) const;
    SphereLight sphere_at(std::uint32_t sphere, float time) const {
        return sphere_light_at(spheres_[sphere], time);
    }
    SphereLight sphere_light_at(std::size_t light, float time) const;
    /// Index in lights() of an Intersector sphere.
    std::int64_t sphere_index(std::uint32_t sphere) const { return spheres_[sphere]; }
    /// Index in lights() of a triangle; -1: the triangle is no light.
    std::int64_t triangle_index(std::uint32_t instance, std::uint32_t primitive) const;
    /// Whether the light changes over time.
    bool moves(std::size_t light) const {
        return keys_of(light) || motion_.triangles.contains(std::uint32_t(light));
    }
    bool has_environment() const { return environment_.has_value(); }
    /// Index of the environment.
    static constexpr std::int32_t kEnvironment = -1;
    /// Whether light sampling includes the environment: it is not uniform.
    bool samples_environment() const { return environment_pmf_ > 0; }
    const std::vector<Light>& lights() const { return lights_; }
    /// A triangle light at a time; empty while it is hidden.
    std::optional<TriangleLight> triangle_at(std::size_t light, float time) const;
    /// A light at a time, of any kind but triangles (triangle_at).
    Light light_at(std::size_t light, float time) const;
    /// Profile factor on the emission of a light at a time in the direction `away` (unit); not for triangles.
    Rgb shaped(const Light& now, Vec3f away) const;
    /// Profile of a light; null: none.
    const LightProfile* profile_of(std::size_t light) const;
    /// Bounds of a light over all times; intensity 0: never emits, or is at infinity.
    LightBounds bounds_of(std::size_t light) const;
    /// Largest illuminance by a light from infinity on a facing surface, lux; 0 for other lights.
    float infinite_weight(std::size_t light) const;
    const std::optional<Environment>& environment() const { return environment_; }

  private:
    static constexpr std::int32_t kNone = -2;
    void take_profiles();
    void build_changes();
    void build_groups(LightChoice choice);
    void add_local(std::size_t light);
    void build_lookup();
    float infinite_probability(Vec3f position) const;
    float infinite_share(float local) const;
    bool sample_local(const LightTree::Choice& choice, float p_local, Vec2f u, Vec3f position, float time,
                      const Wavelengths& wavelengths, LightSample& out) const;
    std::optional<LightSample> sample_infinite(float u_select, float p_infinite, Vec2f u,
                                               float time,
                                               const Wavelengths& wavelengths) const;
    std::optional<LightSample> sample_infinite_at(int index, float probability, Vec2f u, float time,
                                                  const Wavelengths& wavelengths) const;
    std::optional<EmitterSample> with_profile(const Light& now, std::optional<EmitterSample> sample) const;
    std::optional<EmitterSample> sample_other(std::size_t light, Vec2f u, Vec3f position,
                                              float time) const;
    const Keyed<Light>* keys_of(std::size_t light) const {
        return keys_.empty() ? nullptr : keys_[light];
    }
    float local_probability(Vec3f position, std::size_t light) const;

    std::vector<Light> lights_;
    std::optional<Environment> environment_, sampled_;   // sampled_: the same light, with SkyDensity
    LightMotion motion_;
    LightProfiles profiles_;
    std::vector<const Keyed<Light>*> keys_;  // per light, pointers into motion_; empty: no light changes
    LightTree tree_;
    std::vector<TriangleSampler> triangles_;  // per tree index; also holds the index of the light
    std::vector<std::int32_t> tree_index_;    // per light; kNone: dark
    DiscreteDistribution infinite_;
    std::vector<std::int32_t> infinite_lights_;  // light, or kEnvironment
    float infinite_illuminance_ = 0;  // lux, sum on facing surfaces
    float environment_pmf_ = 0;       // in the group of infinite lights
    std::vector<std::uint32_t> spheres_;  // light of each sphere
    std::vector<std::int64_t>
        first_slot_;  // per instance, index into triangle_slots_; -1: no lights
    std::vector<std::int32_t> triangle_slots_;  // light of each primitive, or kNone
};

}  // namespace dg
