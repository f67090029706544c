// scene.cpp -- builds a scene, and intersects rays.
#include "scene/scene.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "material/material_needs.h"
#include "math/hash.h"
#include "scene/footprint.h"
#include "scene/memory_need.h"
#include "scene/pyramids.h"
#include "scene/validate.h"

namespace dg {
namespace {

/// Whether a mesh needs opacity tests. False if every point is opaque in spite of the material's alpha mode, since many
/// exporters always write "blend".
bool may_be_transparent(const Material& material, const Mesh& mesh,
                        const std::vector<Texture>& textures) {
    if (!has_cutout(material, textures)) return false;
    const auto* gltf = std::get_if<GltfMaterial>(&material.kind);
    if (!gltf || !mesh.colors.empty() || material.opacity < 1 || material.opacity_texture.used()) return true;
    const TextureSlot& slot = gltf->base_color_texture;
    if (slot.used() && textures[slot.index].channels % 2 == 0)
        return true;  // 2, 4: has alpha
    const Vec2f uv[2]{};
    GltfMaterial plain = *gltf;
    plain.base_color_texture = {};
    return opacity({material.name, plain}, textures, uv, 1) < 1;
}

/// Uniform random number in [0,1), a function of ray, triangle and `salt`, independent of the order of traversal.
float random_of(const Ray& ray, const RawHit& hit, std::uint32_t salt) {
    auto pair = [](float a, float b) {
        return std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 |
               std::bit_cast<std::uint32_t>(b);
    };
    const std::uint64_t h =
        hash64(pair(ray.origin.x, ray.origin.y), pair(ray.origin.z, ray.direction.x),
               pair(ray.direction.y, ray.direction.z),
               std::uint64_t(hit.instance) << 32 | (hit.primitive ^ salt));
    return static_cast<float>(h >> 40) * 0x1p-24f;
}

/// Hash of the position on a curve, since a ray may hit a segment twice.
std::uint32_t place_on_curve(const InstanceRecord& record, const RawHit& hit) {
    return record.curves ? std::bit_cast<std::uint32_t>(hit.v) << 4 : 0;
}

// The choice of a mixture's part and the opacity test use different random numbers.
constexpr std::uint32_t kOfChoice = 0x9e3779b9u;

bool within_limits(const Affine3d& m) {
    return dg::within_limits(m.x) && dg::within_limits(m.y) && dg::within_limits(m.z) && dg::within_limits(m.origin);
}

/// Converts seconds to fractions of the interval. Instances with an extent of 0 at all times, which files use to hide
/// objects, are removed.
void place_in(Instance& instance, const TimeInterval& interval) {
    if (instance.shown) {
        const Shown shown = instance.shown->over(interval);
        instance.shown = shown.always() ? nullptr : std::make_shared<const Shown>(shown);
    }
    if (!instance.motion) return;
    const Motion motion = instance.motion->over(interval.open, interval.close);
    instance.motion = motion.moves() ? std::make_shared<const Motion>(motion) : nullptr;
    instance.world_from_local = to_float(motion.at(0));
    const Affine3d still = to_double(instance.world_from_local);
    if (motion.moves() || (within_limits(still) && is_invertible(still))) return;
    instance.world_from_local = {};
    instance.shown = std::make_shared<const Shown>();
}

}  // namespace

Scene::Scene(SceneDescription description) : description_(std::move(description)) {}
Scene::~Scene() = default;

std::shared_ptr<const Scene> Scene::build(SceneDescription description) {
    for (Instance& instance : description.instances) place_in(instance, description.interval);
    validate(description);
    check_memory(description);
    for (Mesh& mesh : description.meshes) mesh.curves.complete(mesh);
    build_pyramids(description.textures, description.materials);
    Changes changes = take_changes(description);
    std::shared_ptr<Scene> scene(new Scene(std::move(description)));
    scene->changes_ = std::move(changes);
    link_mixtures(scene->description_.materials, scene->changes_.materials);
    scene->find_media();
    scene->find_solids();
    const auto geometry = scene->geometry_of_instances();
    scene->build_intersector(geometry);
    scene->build_records(geometry);
    scene->build_lights();
    scene->measure();
    return scene;
}

std::vector<InstanceGeometry> Scene::geometry_of_instances() {
    const bool delta_lights =
        std::ranges::any_of(description_.lights, [](const Light& light) {
            return !std::holds_alternative<SphereLight>(light);
        });
    std::vector<InstanceGeometry> geometry;
    for (std::uint32_t k = 0; k < description_.instances.size(); ++k) {
        const Instance& i = description_.instances[k];
        const bool cutout = std::ranges::any_of(keys_of(i.material), [&](const Material& m) {
            return may_be_transparent(m, description_.meshes[i.mesh], description_.textures);
        });
        const Clear clear = clear_for_shadows(k, delta_lights);
        has_clear_ = has_clear_ || clear != Clear::no;
        geometry.push_back(
            {i.mesh, i.world_from_local, cutout, clear, i.motion.get(), i.shown.get(), i.catcher.has_value()});
        has_catchers_ = has_catchers_ || i.catcher;
    }
    return geometry;
}

void Scene::build_intersector(const std::vector<InstanceGeometry>& geometry) {
    intersector_ = Intersector::build(
        description_.meshes, geometry, spheres(),
        [this](const Ray& ray, const RawHit& hit) { return passes(ray, hit); });
}

/// Without delta lights, shadow rays need no tests for volumes.
Clear Scene::clear_for_shadows(std::uint32_t index, bool delta_lights) const {
    const Instance& instance = description_.instances[index];
    const auto bounds = description_.media.of_material.find(instance.material);
    if (bounds != description_.media.of_material.end() && bounds->second.invisible) return Clear::sheet;
    if (rank(index) > 0) return Clear::volume;   // other solids may hide its boundary
    const MaterialChange* change = change_of(instance.material);
    const Clear clear = change ? clearness(change->range)
                               : clearness(description_.materials[instance.material]);
    return clear == Clear::volume && !delta_lights ? Clear::no : clear;
}

void Scene::build_records(const std::vector<InstanceGeometry>& geometry) {
    records_.reserve(description_.instances.size());
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        const MaterialChange* change = change_of(instance.material);
        records_.push_back(make_record(
            description_.meshes[instance.mesh],
            change ? change->range.most : description_.materials[instance.material],
            instance.material, geometry[i], intersector_->is_flattened(i)));
    }
}

bool Scene::is_of_object(std::int32_t light) const {
    if (light < 0) return false;
    const auto* triangle = std::get_if<TriangleLight>(&lights_.lights()[std::size_t(light)]);
    return triangle && !catcher(triangle->instance);
}

void Scene::measure() {
    bounds_ = Bounds::none();
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        const Mesh& mesh = description_.meshes[instance.mesh];
        triangle_count_ += mesh.triangles.size();
        if (!instance.motion || !mesh.empty()) bounds_.hold(bounds_of(i));
    }
    if (bounds_.is_empty()) bounds_ = {};
}

/// Stochastic alpha: the ray passes with probability 1 - opacity.
bool Scene::passes(const Ray& ray, const RawHit& hit) const {
    const InstanceRecord& record = records_[hit.instance];
    SurfaceHit surface;
    interpolate_attributes(record, hit.primitive, hit.u, hit.v, surface);
    const MaterialAt material = material_at(record.material, ray.time);
    const float alpha =
        opacity(material, description_.textures, surface.uv, surface.color[3], ray.time);
    if (alpha >= 1) return false;
    return alpha <= 0 || random_of(ray, hit, place_on_curve(record, hit)) >= alpha;
}

void Scene::find_surface(const Ray& ray, const RawHit& raw, SurfaceHit& hit) const {
    hit.wo = -ray.direction;
    hit.t = raw.t;
    hit.time = ray.time;
    hit.primitive = raw.primitive;
    hit.instance = raw.instance;
    const InstanceRecord& record = records_[raw.instance];
    PlacementRoom made;
    const Placement& placement = record.placement(ray.time, made);
    surface_at(record, placement, raw.primitive, raw.u, raw.v, hit);
    if (!ray.cone.empty()) set_footprint(record, placement, ray.cone.after(raw.t).width, hit);
    hit.front = dot(hit.ng, hit.wo) > 0;
    if (record.mixed) hit.choice = random_of(ray, raw, place_on_curve(record, raw) ^ kOfChoice);
}

std::optional<Scene::Hit> Scene::intersect(const Ray& ray) const {
    const auto raw = intersector_->intersect(ray);
    std::optional<Hit> result(std::in_place);  // constructed in place for return without a copy
    if (!raw) {
        result.reset();
        return result;
    }
    if (raw->instance != RawHit::kSphere) {
        find_surface(ray, *raw, result->surface);
        return result;
    }
    find_sphere(ray, *raw, *result);
    return result;
}

void Scene::find_sphere(const Ray& ray, const RawHit& raw, Hit& hit) const {
    SurfaceHit& s = hit.surface;
    s.wo = -ray.direction;
    s.t = raw.t;
    s.time = ray.time;
    s.position = ray.origin + ray.direction * raw.t;
    s.instance = RawHit::kSphere;
    s.primitive = raw.primitive;
    hit.sphere_light = raw.primitive;
}

float Scene::curvature(const SurfaceHit& hit) const {
    const InstanceRecord& record = records_[hit.instance];
    PlacementRoom made;
    const float c = mean_curvature(record, record.placement(hit.time, made), hit.primitive);
    return hit.front ? c : -c;
}

Ray spawn_ray(const SurfaceHit& hit, Vec3f wi, float time) {
    Ray ray;
    ray.origin = hit.position + hit.ng * std::copysign(hit.error, dot(hit.ng, wi));
    ray.direction = wi;
    ray.time = time;
    return ray;
}

Ray ray_to(const SurfaceHit& hit, Vec3f wi, float distance, float time) {
    Ray ray = spawn_ray(hit, wi, time);
    if (!(distance < std::numeric_limits<float>::infinity())) return ray;
    const Vec3f to = wi * distance - (ray.origin - hit.position);
    ray.t_max = length(to);
    if (ray.t_max > 0) ray.direction = to * (1 / ray.t_max);
    return ray;
}

Ray ray_to_light(const SurfaceHit& hit, const LightSample& light, float time) {
    Ray ray = ray_to(hit, light.wi, light.distance, time);
    ray.t_max -= light.error;
    return ray;
}

}  // namespace dg
