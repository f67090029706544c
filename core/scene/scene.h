// scene.h -- instances (mesh + transform + material) and lights; immutable once built.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/hit.h"
#include "geometry/intersector.h"
#include "light/emission.h"
#include "light/emission_ray.h"
#include "light/light.h"
#include "material/material.h"
#include "medium/tracking.h"
#include "motion/motion.h"
#include "scene/catcher.h"
#include "scene/changes.h"
#include "scene/instance_record.h"
#include "scene/media.h"

namespace dg {

struct Instance {
    std::string name;
    std::uint32_t mesh, material;
    Affine3f world_from_local;                      // where it does not move
    std::shared_ptr<const Motion> motion = nullptr; // of time in s; null: it stands still
    std::shared_ptr<const Shown> shown = nullptr;   // times in s; null: always there
    std::optional<CatcherEffects> catcher = {};     // nothing: it is an object
};

/// Parts that a scene is built from. Lights made of meshes are found by Scene::build from the
/// materials.
struct SceneDescription {
    std::vector<Mesh> meshes;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Instance> instances;
    std::vector<Light> lights;  // punctual and sphere lights
    std::vector<std::shared_ptr<const LightProfile>> profiles;   // of lights and materials
    SceneMedia media;
    std::optional<Environment> environment;
    LightChoice light_choice = LightChoice::tree;
    /// Exposed interval of the picture, s: the first moment of any row of the film to the last. Inside
    /// the scene time is the fraction of it, 0 .. 1.
    TimeInterval interval;
    /// Bytes that the machine has left to build it in; 0: nobody knows.
    std::uint64_t free_memory = 0;
    /// Changes over time (s), by index; what is not named stays as it is above.
    std::map<std::uint32_t, Keyed<Material, double>> material_keys;
    std::map<std::uint32_t, Keyed<Light, double>> light_keys;
    std::optional<Keyed<EnvironmentPose, double>> environment_keys;
};

class Scene {
  public:
    /// Validates (indices, NaN, singular transforms: Error names the part), finds
    /// emissive triangles, builds the intersector and the light set. A scene without
    /// instances is allowed.
    static std::shared_ptr<const Scene> build(SceneDescription description);
    ~Scene();

    /// Nearest surface. Sphere lights come back with sphere_light >= 0 and only position,
    /// t and wo set. The tangent follows the texture only where the material has a normal
    /// map, and uv is read only where the material has textures.
    struct Hit {
        SurfaceHit surface;
        std::int64_t sphere_light = -1;
        Hit() {}  // written, so that nothing is cleared first and then set (measured)
    };
    /// Nothing for a ray that is not is_traceable().
    std::optional<Hit> intersect(const Ray& ray) const;
    /// The same in two steps (follow.cpp): which point of which surface, and what it is like. The
    /// point can be followed through time, and through scenes that differ in nothing but time.
    /// Surfaces where nothing but media changes are passed.
    std::optional<RawHit> first_hit(const Ray& ray) const {
        return has_bounded_media_ ? first_visible(ray) : intersector_->intersect(ray);
    }
    Hit surface(const Ray& ray, const RawHit& hit) const;
    /// Where it is (m) at a time; nothing while it is not shown. `normal` is asked for on spheres.
    std::optional<Vec3d> follow(const RawHit& hit, Vec3f normal, float time) const;
    /// Directions at infinity stay where they are in the sky, which may turn.
    Vec3f sky_from_world(Vec3f direction, float time) const;
    Vec3f world_from_sky(Vec3f direction, float time) const;

    /// Visibility of light that comes to `ray` (origin as spawn_ray moved it) from
    /// where it ends, not counting what lies there: 0 or 1,
    /// and between them where it passes clear surfaces. It goes through smooth sheets,
    /// which bend nothing, as a path does. The boundaries of volumes are passed only by the
    /// light of delta lights, which no path could find behind them, and as if they did not
    /// bend it: Fresnel's losses at each, and absorption along the straight way, which
    /// begins in `medium`.
    Spectrum visibility(Ray ray, bool delta, const Interior& medium, const Wavelengths& wavelengths) const;

    /// Visibility of light that runs along `ray` from t_min to t_max, all of it through air and sheets. None comes along
    /// a ray that ends before it starts (t_max < 0).
    Spectrum visibility_along(const Ray& ray, const Wavelengths& wavelengths) const;

    bool has_clear() const { return has_clear_; }  // some shadow rays pass surfaces

    // Media (media.cpp).
    bool has_media() const { return has_media_; }
    /// The medium that a ray begins in, found by what it meets: for the first ray of a path.
    Interior medium_around(Ray ray) const;
    /// The medium behind a surface of an instance that is met in `here`; `inside` and `bounds_volume` are its BSDF's.
    Interior beyond(const Interior& here, std::uint32_t instance, const Interior& inside, bool bounds_volume,
                    bool entering) const {
        if (has_media_) return medium_behind(here, instance, inside, bounds_volume, entering);
        return medium_beyond(here, inside, bounds_volume, entering);
    }
    /// Whether nothing but media changes at the surfaces of an instance.
    bool is_invisible(std::uint32_t instance) const { return has_bounded_media_ && media_[instance].invisible; }
    /// Share of light that is left after the way from `begin` to `end` m along the ray.
    Spectrum left_after(const Interior& in, const Ray& ray, float begin, float end,
                        const Wavelengths& wavelengths) const {
        const Spectrum left = in.transmittance(end - begin);
        return in.medium ? left * through_medium(in, ray, begin, end, wavelengths) : left;
    }
    /// Density along a ray in a medium on a grid.
    GridRay grid_ray(const Interior& in, const Ray& ray) const;

    bool has_catchers() const { return has_catchers_; }
    /// Effects that the instance catches; null: it is an object.
    const CatcherEffects* catcher(std::uint32_t instance) const {
        const auto& effects = description_.instances[instance].catcher;
        return effects ? &*effects : nullptr;
    }
    /// Whether a light (index in lights(), or LightSet::kEnvironment) comes with an object. Lamps without a mesh and the
    /// environment are the set's.
    bool is_of_object(std::int32_t light) const;

    /// Material at the hit's time.
    MaterialAt material(const SurfaceHit& hit) const {
        return material_at(records_[hit.instance].material, hit.time);
    }
    /// Mean curvature (1/m) of the interpolated normals over the hit's triangle as seen from
    /// wo: positive where the surface bulges toward it. 0 without vertex normals.
    float curvature(const SurfaceHit& hit) const;
    const std::vector<Texture>& textures() const { return description_.textures; }
    const LightSet& lights() const { return lights_; }
    /// Light sampling with textured emission resolved (see LightSample::uneven).
    std::optional<LightSample> sample_light(float u_select, Vec2f u, Vec3f position,
                                            float time,
                                            const Wavelengths& wavelengths) const;

    /// Factor of the material's profile on what the hit emits toward hit.wo.
    Rgb shaping(const Material& material, const SurfaceHit& hit) const {
        if (material.profile < 0) return {1, 1, 1};
        return profile_at(material.profile, hit.instance, hit.time, hit.wo);
    }
    void resolve(LightSample& sample, float time, const Wavelengths& wavelengths) const;

    /// Emission (cd/m2) of a point of an emitter `toward` (unit) where it is seen from, as a ray that hits it
    /// would find it on average; `width` (m) of its cone there, across it.
    Rgb emission(const EmissionPoint& point, Vec3f toward, float time, float width = 0) const;
    /// It depends on where on the emitter the point is, and so on the width.
    bool is_uneven(const EmissionPoint& point) const;

    /// Where light may go.
    EmissionReach emission_reach() const;
    /// A ray of EmissionRays on its way, past its own emitter; its value with textures resolved.
    struct Leaving {
        Ray ray;
        Rgb value;
    };
    Leaving leave(const EmissionRay& emitted, float time) const;

    struct Bounds {
        Vec3f min, max;
    };
    /// Bounds of the instances at all times; all 0 without any.
    Bounds bounds() const { return bounds_; }
    std::size_t triangle_count() const { return triangle_count_; }  // instanced
    const SceneDescription& description() const { return description_; }
    const char* intersector_name() const { return intersector_->name(); }

  private:
    explicit Scene(SceneDescription description);
    std::vector<InstanceGeometry> geometry_of_instances();
    void build_intersector(const std::vector<InstanceGeometry>& geometry);
    void build_records(const std::vector<InstanceGeometry>& geometry);
    void build_lights();
    void measure();
    bool passes(const Ray& ray, const RawHit& hit) const;
    void find_surface(const Ray& ray, const RawHit& raw, SurfaceHit& hit) const;
    void find_sphere(const Ray& ray, const RawHit& raw, Hit& hit) const;
    Bounds bounds_of(std::uint32_t instance) const;
    Rgb triangle_emission(std::size_t light, Vec2f barycentric, Vec3f toward, float time,
                          float width = 0) const;
    Rgb profile_at(std::int32_t profile, std::uint32_t instance, float time, Vec3f away) const;
    std::optional<float> peak_of(std::int32_t profile) const;
    LightProfiles light_profiles() const;
    Spectrum transmission(const Ray& ray, float distance, bool delta, const Interior& medium,
                          const Wavelengths& wavelengths) const;
    Spectrum through_medium(const Interior& in, const Ray& ray, float begin, float end,
                            const Wavelengths& wavelengths) const;
    Interior medium_on(std::uint32_t instance, bool inside) const;
    Interior medium_behind(const Interior& here, std::uint32_t instance, const Interior& inside, bool bounds_volume,
                           bool entering) const;
    std::optional<RawHit> first_visible(Ray ray) const;
    void find_media();
    Spectrum through_crossings(const Ray& ray, Crossings& crossings, Interior medium,
                               float distance, const Wavelengths& wavelengths) const;
    void hold(Vec3d point);
    MaterialAt material_at(std::uint32_t material, float time) const {
        if (const MaterialChange* change = change_of(material))
            return MaterialAt(change->keys, time);
        return MaterialAt(&description_.materials[material]);
    }
    const MaterialChange* change_of(std::uint32_t material) const {
        return changes_.materials.empty() ? nullptr : changes_.materials[material].get();
    }
    /// One, where it stays as it is.
    std::span<const Material> keys_of(std::uint32_t material) const {
        if (const MaterialChange* change = change_of(material)) return change->keys.values;
        return {&description_.materials[material], 1};
    }
    std::vector<Keyed<Sphere>> spheres() const;
    Clear clear_for_shadows(const Instance& instance, bool delta_lights) const;
    bool has_clear_ = false, has_catchers_ = false;
    bool has_media_ = false, has_bounded_media_ = false;
    const Medium* fog_ = nullptr;
    std::vector<MediaOfInstance> media_;   // by instance; empty: there are none

    SceneDescription description_;
    std::unique_ptr<Intersector> intersector_;
    std::vector<InstanceRecord> records_;
    Changes changes_;
    LightSet lights_;
    Bounds bounds_{};
    std::size_t triangle_count_ = 0;
};

/// A ray that leaves `hit` along `wi`, its origin moved off the surface to the proper
/// side.
Ray spawn_ray(const SurfaceHit& hit, Vec3f wi, float time);

/// The same, aimed from there at the point that is `distance` metres from the hit along `wi`, where it ends. A lamp that
/// is near and slant is missed along `wi` itself, or met too soon.
Ray ray_to(const SurfaceHit& hit, Vec3f wi, float distance, float time);
/// To what light sampling found; it ends short of the lamp by as much as the lamp is uncertain.
Ray ray_to_light(const SurfaceHit& hit, const LightSample& light, float time);

}  // namespace dg
