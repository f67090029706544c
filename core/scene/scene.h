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
#include "scene/solid_ranks.h"
#include "scene/solids.h"

namespace dg {

struct Instance {
    std::string name;
    std::uint32_t mesh, material;
    Affine3f world_from_local;                      // for static instances
    std::shared_ptr<const Motion> motion = nullptr; // over time in s; null: static
    std::shared_ptr<const Shown> shown = nullptr;   // visibility over time in s; null: always visible
    std::optional<CatcherEffects> catcher = {};     // set for catchers; empty: an object
    Vec3d local_origin{};                           // the mesh's positions are relative to it
};

/// Input of Scene::build, which adds the lights of emissive meshes.
struct SceneDescription {
    std::vector<Mesh> meshes;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Instance> instances;
    std::vector<Light> lights;  // punctual and sphere lights
    std::vector<std::shared_ptr<const LightProfile>> profiles;   // for lights and materials
    SceneMedia media;
    std::map<std::uint32_t, Nesting> nesting;   // of materials, by index; others nest by containment
    std::optional<Environment> environment;
    LightChoice light_choice = LightChoice::tree;
    /// Exposed interval of the picture, s, over all rows of the film. Times inside the scene are fractions of it, 0 ..
    /// 1.
    TimeInterval interval;
    /// Origin of the scene's frame in the world, m; all positions are relative to it, so that they keep their precision
    /// as floats.
    Vec3d origin{};
    /// Available memory for building the scene, bytes; 0: unknown.
    std::uint64_t free_memory = 0;
    /// Animation keys over time (s), by index; materials and lights without keys are static.
    std::map<std::uint32_t, Keyed<Material, double>> material_keys;
    std::map<std::uint32_t, Keyed<Light, double>> light_keys;
    std::optional<Keyed<EnvironmentPose, double>> environment_keys;
};

class Scene {
  public:
    /// Validates the description, collects emissive triangles, and builds the intersector and the light set. Throws
    /// Error that names the part, for invalid indices, NaN and singular transforms. A scene without instances is
    /// allowed.
    static std::shared_ptr<const Scene> build(SceneDescription description);
    ~Scene();

    /// The nearest hit. For sphere lights, sphere_light >= 0 and only position, t and wo are set. The tangent follows
    /// the texture only if the material has a normal map, and uv is set only if the material has textures.
    struct Hit {
        SurfaceHit surface;
        std::int64_t sphere_light = -1;
        Hit() {}  // user-provided, to avoid zero-initialization (measured)
    };
    /// Empty for a miss, and for a ray that is not is_traceable().
    std::optional<Hit> intersect(const Ray& ray) const;
    /// intersect() in two steps (follow.cpp): the raw hit, and its surface attributes. A raw hit can be followed over
    /// time, also in scenes that differ only in time. Passes surfaces that only separate media.
    std::optional<RawHit> first_hit(const Ray& ray) const {
        return has_bounded_media_ ? first_visible(ray) : intersector_->intersect(ray);
    }
    Hit surface(const Ray& ray, const RawHit& hit) const;
    /// Position (m) of a raw hit at a time; empty while it is hidden. `normal` is used only for spheres.
    std::optional<Vec3d> follow(const RawHit& hit, Vec3f normal, float time) const;
    /// Converts directions to and from the frame of the sky, which may rotate.
    Vec3f sky_from_world(Vec3f direction, float time) const;
    Vec3f world_from_sky(Vec3f direction, float time) const;

    /// Transmittance along a shadow ray (with an origin from spawn_ray) up to its end: 0, 1, or a value between them
    /// behind clear surfaces. Passes thin smooth sheets, as paths do. Passes the boundaries of volumes only for delta
    /// lights, which paths cannot find, and ignores refraction: applies the Fresnel transmittance at each boundary, and
    /// absorption along the unrefracted ray, which starts in `medium`.
    Spectrum visibility(const Ray& ray, bool delta, const Interior& medium, const Wavelengths& wavelengths) const;
    /// The same for a ray that may start in overlapping solids.
    Spectrum visibility_nested(const Ray& ray, bool delta, const Surroundings& here,
                               const Wavelengths& wavelengths) const;

    /// Transmittance along `ray` from t_min to t_max through air and thin sheets; 0 for t_max < 0.
    Spectrum visibility_along(const Ray& ray, const Wavelengths& wavelengths) const;
    /// The same from a point in `here`. Passes the boundaries of volumes for delta lights.
    Spectrum visibility_from(const Surroundings& here, const Ray& ray, bool delta,
                             const Wavelengths& wavelengths) const;

    bool has_clear() const { return has_clear_; }  // some surfaces transmit shadow rays

    // Media (media.cpp).
    bool has_media() const { return has_media_; }
    /// The medium at the origin of a ray, determined from its hits; for the first ray of a path.
    Interior medium_around(Ray ray) const;
    // Refracting solids (surroundings.cpp).
    /// Whether solids overlap, so that boundaries may be hidden.
    bool has_nested() const { return !ranks_.of_instance.empty(); }
    /// The first overlaps.
    const std::vector<Overlap>& overlaps() const { return ranks_.overlaps; }
    /// Whether more solids are nested than Solids::kMost.
    bool nests_too_deeply() const { return ranks_.deepest > Solids::kMost; }
    /// Rank among overlapping solids; 0: the surface is no boundary of such a solid.
    std::uint32_t rank(std::uint32_t instance) const { return has_nested() ? ranks_.of_instance[instance] : 0; }
    /// Sets the index outside a boundary that is hit in `solids`; false: a solid of a higher rank hides it.
    bool resolve_boundary(const Solids& solids, SurfaceHit& hit, const Wavelengths& wavelengths) const;
    /// Whether a solid other than `instance` is in `solids`.
    bool in_other(const Solids& solids, std::uint32_t instance) const {
        return solids.top(ranks_.of_instance, instance) != Solids::kNone;
    }
    /// Enters or leaves the solid of a boundary, and solids with boundaries at the same place.
    void cross_boundary(Solids& solids, const SurfaceHit& hit, bool entering) const;
    /// The inside of the solid with the highest rank, or the fog.
    Interior interior_in(const Solids& solids, float time, const Wavelengths& wavelengths) const;
    /// Solids, by index, that may hold a point of the box at some time.
    std::vector<std::uint32_t> solids_near(const Box& box) const;
    /// Surroundings of the origin of a camera ray; empty: the ray begins in none of the solids `near`.
    std::optional<Surroundings> around(const Ray& ray, std::span<const std::uint32_t> near,
                                       const Wavelengths& wavelengths) const;
    /// Whether a ray begins in a solid.
    bool begins_in_solid(const Ray& ray) const;
    std::vector<EnclosingSolid> enclosing_solids(Vec3f point, float time) const;
    /// Crosses the boundary of a ranked solid.
    void cross_nested(Surroundings& here, const SurfaceHit& hit, bool entering, const Wavelengths& wavelengths) const;
    /// The medium behind a surface of an instance that is hit inside `here`; `inside` and `bounds_volume` are from its
    /// BSDF.
    Interior beyond(const Interior& here, std::uint32_t instance, const Interior& inside, bool bounds_volume,
                    bool entering) const {
        if (has_media_) return medium_behind(here, instance, inside, bounds_volume, entering);
        return medium_beyond(here, inside, bounds_volume, entering);
    }
    /// Whether the surfaces of an instance only separate media.
    bool is_invisible(std::uint32_t instance) const { return has_bounded_media_ && media_[instance].invisible; }
    /// Transmittance of a volume or medium from `begin` to `end` m along the ray.
    Spectrum transmittance_through(const Interior& in, const Ray& ray, float begin, float end,
                                   const Wavelengths& wavelengths) const {
        const Spectrum of_volume = in.transmittance(end - begin);
        return in.medium ? of_volume * through_medium(in, ray, begin, end, wavelengths) : of_volume;
    }
    /// A ray in the space of a medium's density grid.
    GridRay grid_ray(const Interior& in, const Ray& ray) const;

    bool has_catchers() const { return has_catchers_; }
    /// Effects of a catcher; null for objects.
    const CatcherEffects* catcher(std::uint32_t instance) const {
        const auto& effects = description_.instances[instance].catcher;
        return effects ? &*effects : nullptr;
    }
    /// Whether a light (index in lights(), or LightSet::kEnvironment) belongs to an object. Lamps without a mesh and
    /// the environment do not: like catchers, they are part of the scene without objects.
    bool is_of_object(std::int32_t light) const;

    /// Material at the hit's time.
    MaterialAt material(const SurfaceHit& hit) const {
        return material_at(records_[hit.instance].material, hit.time);
    }
    /// Mean curvature (1/m) from the vertex normals of the hit's triangle: positive if it is convex toward wo; 0
    /// without vertex normals.
    float curvature(const SurfaceHit& hit) const;
    const std::vector<Texture>& textures() const { return description_.textures; }
    /// The BSDF at a hit of a camera path, which is moved to the smooth surface (smooth_surface.h).
    Bsdf shade_smooth(const Material& material, SurfaceHit& hit, const Wavelengths& wavelengths) const {
        if (hit.smooth) lift(hit);
        return shade(material, textures(), hit, wavelengths);
    }
    /// The point that the ray has hit, also after shade_smooth().
    Vec3f met(const SurfaceHit& hit) const;
    const LightSet& lights() const { return lights_; }
    /// Radiance of a light sample, with textures and the picture of the sky (LightSample::uneven).
    Spectrum radiance(const LightSample& sample, float time, const Wavelengths& wavelengths) const {
        return sample.uneven ? uneven_radiance(sample, time, wavelengths) : sample.radiance;
    }
    /// Profile factor on the emission of a hit toward hit.wo.
    Rgb shaping(const Material& material, const SurfaceHit& hit) const {
        if (material.profile < 0) return {1, 1, 1};
        return profile_at(material.profile, hit.instance, hit.time, hit.wo);
    }
    /// Mean emission (cd/m2) that rays find at a point of an emitter in the direction `toward` (unit). `width` (m):
    /// width of the ray cone at the point.
    Rgb emission(const EmissionPoint& point, Vec3f toward, float time, float width = 0) const;
    /// Whether emission() depends on the point on the emitter, and on the width.
    bool is_uneven(const EmissionPoint& point) const;

    /// Bounds of lit surfaces, and targets of light paths.
    EmissionReach emission_reach() const;
    /// A ray of EmissionRays, with its origin offset from the emitter, and its value including textures.
    struct Leaving {
        Ray ray;
        Rgb value;
    };
    Leaving leave(const EmissionRay& emitted, float time) const;

    using Bounds = dg::Bounds;
    /// Bounds of the instances over all times; 0 without instances.
    Bounds bounds() const { return bounds_; }
    /// Origin of the scene's frame in the world, m.
    Vec3d origin() const { return description_.origin; }
    std::size_t triangle_count() const { return triangle_count_; }  // of all instances
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
    void lift(SurfaceHit& hit) const;
    void find_sphere(const Ray& ray, const RawHit& raw, Hit& hit) const;
    Bounds bounds_of(std::uint32_t instance) const;
    Rgb triangle_emission(std::size_t light, Vec2f barycentric, Vec3f toward, float time,
                          float width = 0) const;
    Spectrum uneven_radiance(const LightSample& sample, float time, const Wavelengths& wavelengths) const;
    Rgb profile_at(std::int32_t profile, std::uint32_t instance, float time, Vec3f away) const;
    std::optional<float> peak_of(std::int32_t profile) const;
    LightProfiles light_profiles() const;
    template <class Around>   // Interior or Surroundings
    Spectrum transmittance_to_light(Ray ray, bool delta, const Around& here, const Wavelengths& wavelengths) const;
    template <class Around>
    Spectrum transmission(const Ray& ray, float distance, bool delta, const Around& here,
                          const Wavelengths& wavelengths) const;
    Spectrum through_medium(const Interior& in, const Ray& ray, float begin, float end,
                            const Wavelengths& wavelengths) const;
    Interior medium_on(std::uint32_t instance, bool inside) const;
    Interior medium_behind(const Interior& here, std::uint32_t instance, const Interior& inside, bool bounds_volume,
                           bool entering) const;
    std::optional<RawHit> first_visible(Ray ray) const;
    std::optional<RawHit> first_surface(Ray ray) const;
    void find_media();
    void find_solids();
    void cross_coincident(Solids& solids, const SurfaceHit& hit, bool onward) const;
    SolidOptics optics_in(std::uint32_t instance, float time, const Wavelengths& wavelengths) const;
    template <typename Use>
    void leave_solids(Ray ray, const Use& use) const;
    template <class Around>
    Spectrum through_crossings(const Ray& ray, Crossings& crossings, bool delta, Around around, float distance,
                               const Wavelengths& wavelengths) const;
    MaterialAt material_at(std::uint32_t material, float time) const {
        if (const MaterialChange* change = change_of(material))
            return MaterialAt(change->keys, time);
        return MaterialAt(&description_.materials[material]);
    }
    const MaterialChange* change_of(std::uint32_t material) const {
        return changes_.materials.empty() ? nullptr : changes_.materials[material].get();
    }
    /// The keys of a material; a single key if it is static.
    std::span<const Material> keys_of(std::uint32_t material) const {
        if (const MaterialChange* change = change_of(material)) return change->keys.values;
        return {&description_.materials[material], 1};
    }
    std::vector<Keyed<Sphere>> spheres() const;
    Clear clear_for_shadows(std::uint32_t instance, bool delta_lights) const;
    bool has_clear_ = false, has_catchers_ = false;
    bool has_media_ = false, has_bounded_media_ = false;
    const Medium* fog_ = nullptr;
    std::vector<MediaOfInstance> media_;   // per instance; empty: no media
    std::vector<BoundedSolid> solids_;    // in the order of the instances
    SolidRanks ranks_;

    SceneDescription description_;
    std::unique_ptr<Intersector> intersector_;
    std::vector<InstanceRecord> records_;
    Changes changes_;
    LightSet lights_;
    Bounds bounds_{};
    std::size_t triangle_count_ = 0;
};

/// A ray that leaves `hit` along `wi`, with its origin offset from the surface on the side of wi.
Ray spawn_ray(const SurfaceHit& hit, Vec3f wi, float time);

/// A ray from the offset origin to the point at `distance` m from the hit along `wi`, where it ends. Without the
/// correction for the offset, a ray may miss a near lamp at a grazing angle, or hit it too early.
Ray ray_to(const SurfaceHit& hit, Vec3f wi, float distance, float time);
/// A shadow ray to a light sample; it ends before the lamp by the error bound of its position.
Ray ray_to_light(const SurfaceHit& hit, const LightSample& light, float time);

}  // namespace dg
