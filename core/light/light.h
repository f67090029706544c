// light.h -- emitters: sample, pdf, emission. They take geometry, never the scene.
// Photometric law: colours are Rgb of D65-shaped spectra; intensity cd, illuminance lux,
// luminance cd/m2.
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
    Vec3f direction;                 // unit, where it shines
    Rgb intensity;                   // cd, on the axis
    float inner_angle, outer_angle;  // rad, half angles
    float range = std::numeric_limits<float>::infinity();
};
/// Light from infinity: parallel, or from an even disc that light sampling alone finds (emitter.h).
struct DirectionalLight {
    Vec3f direction;  // unit, where it shines; of a disc from its middle
    Rgb illuminance;  // lux, on a surface that faces it
    float angle = 0;  // rad, diameter of the disc; 0: parallel
};
/// A ball that shines evenly, or by a profile; rays can hit it (Intersector sphere `sphere`).
struct SphereLight {
    Sphere shape;
    Rgb luminance;  // cd/m2
    LampShape lamp{};
};
/// One emissive triangle, world space.
struct TriangleLight {
    Vec3f a, b, c;
    Rgb mean_luminance;  // cd/m2, mean over the triangle: steers the choice of lights
                         // only
    std::uint32_t instance, primitive;
    bool two_sided;
    bool mirrored = false;  // the front is where a, b, c run clockwise (instance with
                            // determinant < 0)
    bool even =
        false;  // the side or sides that shine do so with mean_luminance everywhere
};
using Light =
    std::variant<PointLight, SpotLight, DirectionalLight, SphereLight, TriangleLight>;

/// Shape of the kinds that may have a profile; null for the others.
const LampShape* lamp_of(const Light& light);
LampShape* lamp_of(Light& light);

/// Motion of lights while the shutter is open (fractions of the scene's interval), by their index;
/// those that are not named stay as they are. See light_keys.h.
struct LightMotion {
    std::map<std::uint32_t, Keyed<Light>> keys;  // of one kind each; no triangles
    /// Triangles that move, each with bounds of all that it ever reaches.
    std::map<std::uint32_t, LightBounds> triangles;
    /// Puts one of them where it is at a time; false while it is not there at all.
    std::function<bool(TriangleLight&, float time)> place;
};

/// Profiles that the lights of a scene refer to by index.
struct LightProfiles {
    std::vector<std::shared_ptr<const LightProfile>> list{};
    std::vector<std::int32_t> of_instance{};   // of its triangle lights; -1: none. Empty: none at all
};

struct LightSample {
    Vec3f wi;           // unit, toward the light
    float distance;     // m; infinity for directional and environment
    Spectrum radiance;  // incident radiance; for a delta light the incident irradiance on
                        // a facing surface
    float pdf;  // solid angle, selection included; for a delta light the selection
                // probability
    bool delta;  // light sampling alone finds it: it has no size, or is the disc of a sun
    /// Index in lights(), or kEnvironment; of a triangle also where it was sampled (weights
    /// of its second and third corner).
    std::int32_t light = -1;
    Vec2f barycentric;
    /// The triangle does not shine evenly: the scene evaluates the emission there.
    bool uneven = false;
    float error = 0;  // m, along wi: how far from there a ray may meet the lamp
};

struct TriangleSampler;
struct LightWay;
struct EmitterSample;

/// How one light with a place is chosen: by the tree; by power alone or evenly, to
/// measure what the tree is worth.
enum class LightChoice { tree, power, even };

/// All lights of a scene with the law by which one is chosen for a point: by an estimate
/// of the illuminance that each brings there, so that neither a huge scene nor a near
/// lamp starves the others. Lights from infinity (directional, environment) form one
/// group, the rest a LightTree. The choice is the same at all times: it knows where each
/// light ever is and how bright it ever gets. What is sampled is the light at the time.
class LightSet {
  public:
    LightSet();
    ~LightSet();
    LightSet(LightSet&&) noexcept;
    LightSet& operator=(LightSet&&) noexcept;
    /// Throws Error naming light and value: not finite, negative colour, zero direction,
    /// radius or range not positive, angles of a spot out of order.
    LightSet(std::vector<Light> lights, std::optional<Environment> environment,
             LightChoice choice = LightChoice::tree, LightMotion motion = {}, LightProfiles profiles = {});

    bool empty() const { return tree_.empty() && infinite_.empty(); }
    /// Radiance of triangle lights is mean_luminance here; LightSample::uneven tells the
    /// caller to replace it by the textured value. Empty when the choice cannot
    /// light the position.
    std::optional<LightSample> sample(float u_select, Vec2f u, Vec3f position, float time,
                                      const Wavelengths& wavelengths) const;
    static constexpr std::size_t kMostSamples = LightTree::kMostAtOnce;
    /// Several samples of the same law, spread over the lights: some of `found` are without light (pdf 0).
    void sample_several(float u_select, Vec2f u, Vec3f position, float time, const Wavelengths& wavelengths,
                        std::span<LightSample> found) const;
    /// One light for a way through a medium, on all places of which it may be sampled: its index, or kEnvironment, and
    /// the chance of that. Empty when no light shines there.
    struct Choice {
        std::int32_t light;
        float probability;
    };
    std::optional<Choice> choose(float u, const LightWay& way) const;
    /// The chance by the law of sample().
    float choice_probability(std::int32_t light, Vec3f position) const;
    /// A sample of one light, as sample() has it; its pdf is without the choice.
    std::optional<LightSample> sample_one(std::int32_t light, Vec2f u, Vec3f position, float time,
                                          const Wavelengths& wavelengths) const;
    /// The point of a light that sample_one() finds with the same u, or its middle; nothing at infinity.
    struct Place {
        Vec3f position;
        Vec3f normal;   // of any length: it shines before its plane alone; zero: on all sides
    };
    std::optional<Place> place_of(std::int32_t light, Vec2f u, float time) const;
    /// Illuminance that all lights may bring to a point, lux: the estimate by which one is chosen, which knows of
    /// nothing in between.
    float illuminance(Vec3f position) const {
        return infinite_illuminance_ + (tree_.empty() ? 0 : tree_.importance(position));
    }
    /// Lights among which one is chosen.
    std::size_t choices() const { return tree_.size() + infinite_lights_.size(); }
    /// Solid-angle density (selection included) with which sample() would have chosen the
    /// direction from `position` that met this triangle at `t` metres under |cos| at the
    /// light. 0 for triangles that are not lights. Two-sided or not is the caller's
    /// knowledge: ask only where it emits. `position` is the one that sample() was given,
    /// since the choice of the light depends on it.
    float pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float t,
                       float cos_light, Vec3f position, float time) const;
    float pdf_sphere(std::uint32_t sphere, Vec3f position, float time) const;
    /// 0 everywhere for a constant environment: light sampling leaves it to the BSDF.
    float pdf_environment(Vec3f direction, Vec3f position, float time) const;
    /// LightSample::pdf, had sample() chosen this light (or kEnvironment) along `wi` at `distance`.
    float pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance, float time) const;
    /// Emission seen by a ray that hit sphere light `sphere`, whose light goes `away` / left the scene.
    Spectrum sphere_radiance(std::uint32_t sphere, Vec3f away, float time,
                             const Wavelengths& wavelengths) const;
    Spectrum environment_radiance(Vec3f direction, float time,
                                  const Wavelengths& wavelengths) const;
    SphereLight sphere_at(std::uint32_t sphere, float time) const {
        return sphere_light_at(spheres_[sphere], time);
    }
    SphereLight sphere_light_at(std::size_t light, float time) const;
    /// Index in lights() of the sphere light that rays meet as this sphere; of a triangle light, or -1.
    std::int64_t sphere_index(std::uint32_t sphere) const { return spheres_[sphere]; }
    std::int64_t triangle_index(std::uint32_t instance, std::uint32_t primitive) const;
    /// Whether it is elsewhere, or another, at other times.
    bool moves(std::size_t light) const {
        return keys_of(light) || motion_.triangles.contains(std::uint32_t(light));
    }
    bool has_environment() const { return environment_.has_value(); }
    /// Index that stands for the environment among those of lights.
    static constexpr std::int32_t kEnvironment = -1;
    /// Whether light sampling looks for it: it is no even sky.
    bool samples_environment() const { return environment_pmf_ > 0; }
    const std::vector<Light>& lights() const { return lights_; }
    /// A triangle light where it is at a time; empty while it is not there at all.
    std::optional<TriangleLight> triangle_at(std::size_t light, float time) const;
    /// Any other as it is at a time.
    Light light_at(std::size_t light, float time) const;
    /// Factor on the light of one that is no triangle (a light as it is at a time) which goes `away` (unit).
    Rgb shaped(const Light& now, Vec3f away) const;
    /// Null: it shines as its kind does.
    const LightProfile* profile_of(std::size_t light) const;
    /// Where a light ever is, and how bright it ever gets; intensity 0: never, or at infinity.
    LightBounds bounds_of(std::size_t light) const;
    /// How bright a light from infinity ever is on a surface that faces it, lux; 0 for the others.
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
    std::optional<Environment> environment_;
    LightMotion motion_;
    LightProfiles profiles_;
    std::vector<const Keyed<Light>*> keys_;  // by light, into motion_; empty: none changes
    LightTree tree_;
    std::vector<TriangleSampler> triangles_;  // by tree index, and the number of any light there
    std::vector<std::int32_t> tree_index_;    // and back; kNone: dark
    DiscreteDistribution infinite_;
    std::vector<std::int32_t> infinite_lights_;  // light, or kEnvironment
    float infinite_illuminance_ = 0;  // lux, all together, on a surface that faces them
    float environment_pmf_ = 0;       // within the group
    std::vector<std::uint32_t> spheres_;  // light by sphere
    std::vector<std::int64_t>
        first_slot_;  // by instance, into triangle_slots_; -1: no lights
    std::vector<std::int32_t> triangle_slots_;  // light by primitive; kNone
};

}  // namespace dg
