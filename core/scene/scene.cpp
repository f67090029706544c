// scene.cpp -- building a scene, and asking it for surfaces, shadows and light.
#include "scene/scene.h"

#include <algorithm>
#include <bit>

#include "math/hash.h"
#include "scene/emission.h"
#include "scene/footprint.h"
#include "scene/pyramids.h"
#include "scene/validate.h"

namespace dg {
namespace {

/// False where every point of the mesh is opaque although the material allows otherwise,
/// as many exporters write "blend" everywhere: rays through it need not ask.
bool may_be_transparent(const Material& material, const Mesh& mesh,
                        const std::vector<Texture>& textures) {
    if (!has_cutout(material, textures)) return false;
    const auto* gltf = std::get_if<GltfMaterial>(&material.kind);
    if (!gltf || !mesh.colors.empty()) return true;
    const TextureSlot& slot = gltf->base_color_texture;
    if (slot.used() && textures[slot.index].channels % 2 == 0)
        return true;  // 2, 4: has alpha
    const Vec2f uv[2]{};
    GltfMaterial plain = *gltf;
    plain.base_color_texture = {};
    return opacity({material.name, plain}, textures, uv, 1) < 1;
}

/// Uniform in [0,1), the same for the same ray and triangle whatever the order of
/// traversal.
float cutout_random(const Ray& ray, const RawHit& hit) {
    auto pair = [](float a, float b) {
        return std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 |
               std::bit_cast<std::uint32_t>(b);
    };
    const std::uint64_t h =
        hash64(pair(ray.origin.x, ray.origin.y), pair(ray.origin.z, ray.direction.x),
               pair(ray.direction.y, ray.direction.z),
               std::uint64_t(hit.instance) << 32 | hit.primitive);
    return static_cast<float>(h >> 40) * 0x1p-24f;
}

/// The wall between seconds and fractions of the interval.
void place_in(Instance& instance, const TimeInterval& interval) {
    if (!instance.motion) return;
    const Motion motion = instance.motion->over(interval.open, interval.close);
    instance.world_from_local = to_float(motion.at(0));
    instance.motion = motion.moves() ? std::make_shared<const Motion>(motion) : nullptr;
}

}  // namespace

Scene::Scene(SceneDescription description) : description_(std::move(description)) {}
Scene::~Scene() = default;

std::shared_ptr<const Scene> Scene::build(SceneDescription description) {
    for (Instance& instance : description.instances) place_in(instance, description.interval);
    validate(description);
    build_pyramids(description.textures, description.materials);
    std::shared_ptr<Scene> scene(new Scene(std::move(description)));
    scene->build_intersector();
    scene->build_records();
    scene->build_lights();
    scene->measure();
    return scene;
}

void Scene::build_intersector() {
    const bool delta_lights =
        std::ranges::any_of(description_.lights, [](const Light& light) {
            return !std::holds_alternative<SphereLight>(light);
        });
    std::vector<InstanceGeometry> geometry;
    for (const Instance& i : description_.instances) {
        const bool cutout =
            may_be_transparent(description_.materials[i.material],
                               description_.meshes[i.mesh], description_.textures);
        const Clear clear = clear_for_shadows(i, delta_lights);
        has_clear_ = has_clear_ || clear != Clear::no;
        geometry.push_back({i.mesh, i.world_from_local, cutout, clear});
    }
    std::vector<Sphere> spheres;
    for (const Light& light : description_.lights) {
        if (const auto* s = std::get_if<SphereLight>(&light)) spheres.push_back(s->shape);
    }
    intersector_ = Intersector::build(
        description_.meshes, geometry, spheres,
        [this](const Ray& ray, const RawHit& hit) { return passes(ray, hit); });
}

/// Where no light is a delta light, shadow rays need not ask about volumes.
Clear Scene::clear_for_shadows(const Instance& instance, bool delta_lights) const {
    const Clear clear = clearness(description_.materials[instance.material]);
    return clear == Clear::volume && !delta_lights ? Clear::no : clear;
}

void Scene::build_records() {
    records_.reserve(description_.instances.size());
    for (std::uint32_t i = 0; i < description_.instances.size(); ++i) {
        const Instance& instance = description_.instances[i];
        records_.push_back(make_record(
            description_.meshes[instance.mesh], description_.materials[instance.material],
            instance.material, instance.world_from_local, intersector_->is_flattened(i)));
    }
}

void Scene::build_lights() {
    std::vector<Light> lights = description_.lights;
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        append_emissive_triangles(
            records_[i], i,
            description_.meshes[description_.instances[i].mesh].triangles.size(),
            description_.materials[records_[i].material], description_.textures, lights);
    }
    lights_ = LightSet(std::move(lights), description_.environment,
                       description_.light_choice);
}

void Scene::measure() {
    bool first = true;
    for (const Instance& instance : description_.instances) {
        const Mesh& mesh = description_.meshes[instance.mesh];
        triangle_count_ += mesh.triangles.size();
        for (Vec3f local : mesh.positions) {
            const Vec3f p = instance.world_from_local.point(local);
            if (first) bounds_ = {p, p};
            first = false;
            bounds_.min = {std::min(bounds_.min.x, p.x), std::min(bounds_.min.y, p.y),
                           std::min(bounds_.min.z, p.z)};
            bounds_.max = {std::max(bounds_.max.x, p.x), std::max(bounds_.max.y, p.y),
                           std::max(bounds_.max.z, p.z)};
        }
    }
}

/// Alpha: the ray passes with probability 1 - opacity.
bool Scene::passes(const Ray& ray, const RawHit& hit) const {
    const InstanceRecord& record = records_[hit.instance];
    SurfaceHit surface;
    interpolate_attributes(record, hit.primitive, hit.u, hit.v, surface);
    const float alpha = opacity(description_.materials[record.material],
                                description_.textures, surface.uv, surface.color[3]);
    if (alpha >= 1) return false;
    return alpha <= 0 || cutout_random(ray, hit) >= alpha;
}

void Scene::find_surface(const Ray& ray, const RawHit& raw, SurfaceHit& hit) const {
    hit.wo = -ray.direction;
    hit.t = raw.t;
    hit.time = ray.time;
    hit.primitive = raw.primitive;
    hit.instance = raw.instance;
    surface_at(records_[raw.instance], raw.primitive, raw.u, raw.v, hit);
    hit.front = dot(hit.ng, hit.wo) > 0;
}

std::optional<Scene::Hit> Scene::intersect(const Ray& ray) const {
    const auto raw = intersector_->intersect(ray);
    std::optional<Hit> result(std::in_place);  // the one object that is returned: no copy
    if (!raw) {
        result.reset();
        return result;
    }
    if (raw->instance != RawHit::kSphere) {
        find_surface(ray, *raw, result->surface);
        if (!ray.cone.empty())
            set_footprint(records_[raw->instance], ray.cone.after(raw->t).width, result->surface);
        return result;
    }
    SurfaceHit& hit = result->surface;
    hit.wo = -ray.direction;
    hit.t = raw->t;
    hit.time = ray.time;
    hit.position = ray.origin + ray.direction * raw->t;
    hit.instance = RawHit::kSphere;
    hit.primitive = raw->primitive;
    result->sphere_light = raw->primitive;
    return result;
}

float Scene::curvature(const SurfaceHit& hit) const {
    const float c = mean_curvature(records_[hit.instance], hit.primitive);
    return hit.front ? c : -c;
}

std::optional<LightSample> Scene::sample_light(float u_select, Vec2f u, Vec3f position,
                                               const Wavelengths& wavelengths) const {
    auto sample = lights_.sample(u_select, u, position, wavelengths);
    if (!sample || !sample->uneven) return sample;
    const auto& light = std::get<TriangleLight>(lights_.lights()[sample->triangle_light]);
    const InstanceRecord& record = records_[light.instance];
    const Vec3f winding = cross(light.b - light.a, light.c - light.a);
    const bool front = (dot(winding, sample->wi) < 0) != light.mirrored;
    const Rgb rgb =
        emission_at(record, description_.materials[record.material],
                    description_.textures, light.primitive, sample->barycentric, front,
                    -sample->wi);
    sample->radiance = wavelengths.emission(rgb);
    return sample;
}

Ray spawn_ray(const SurfaceHit& hit, Vec3f wi, float time) {
    Ray ray;
    ray.origin = hit.position + hit.ng * std::copysign(hit.error, dot(hit.ng, wi));
    ray.direction = wi;
    ray.time = time;
    return ray;
}

}  // namespace dg
