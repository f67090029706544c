// scene_lights.cpp -- the lights of a scene: lights of the description, and emissive meshes.
#include "scene/emission_motion.h"
#include "scene/emissive_mesh.h"
#include "scene/memory_need.h"
#include "scene/scene.h"

namespace dg {

/// Shapes of the sphere lights, in order.
std::vector<Keyed<Sphere>> Scene::spheres() const {
    std::vector<Keyed<Sphere>> spheres;
    for (std::uint32_t i = 0; i < description_.lights.size(); ++i) {
        const auto* still = std::get_if<SphereLight>(&description_.lights[i]);
        if (!still) continue;
        spheres.push_back({{0}, {still->shape}});
        const auto found = changes_.lights.find(i);
        if (found == changes_.lights.end()) continue;
        spheres.back() = {found->second.times, {}};
        for (const Light& key : found->second.values)
            spheres.back().values.push_back(std::get<SphereLight>(key).shape);
    }
    return spheres;
}

void Scene::build_lights() {
    std::vector<Light> lights;
    lights.reserve(description_.lights.size() + MemoryNeed(description_).lamps);   // avoids moves
    lights = description_.lights;
    LightMotion motion{changes_.lights, {}, [this](TriangleLight& light, float time) {
                           return place(records_[light.instance], light, time);
                       }};
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Material& still = description_.materials[records_[i].material];
        const MaterialChange* change = change_of(records_[i].material);
        const Mesh& mesh = description_.meshes[description_.instances[i].mesh];
        const std::size_t first = lights.size();
        append_emissive_triangles(
            records_[i], i, mesh.triangles.size(),
            change ? brightest(change->keys, change->range) : still, change != nullptr,
            description_.textures, lights, peak_of(still.profile));
        if (records_[i].moves())
            bound_moving_triangles(records_[i], mesh, lights, first, motion);
    }
    // Vertices in media draw few directions by their phase function, and rely on light sampling.
    const SkyDensity sky = has_media_ ? SkyDensity::luminance : SkyDensity::compensated;
    lights_ = LightSet(std::move(lights), description_.environment, description_.light_choice, std::move(motion),
                       light_profiles(), sky);
}

/// Largest factor of a profile.
std::optional<float> Scene::peak_of(std::int32_t profile) const {
    if (profile < 0) return std::nullopt;
    return description_.profiles[std::size_t(profile)]->peak();
}

LightProfiles Scene::light_profiles() const {
    LightProfiles profiles{description_.profiles};
    if (profiles.list.empty()) return profiles;
    for (const InstanceRecord& record : records_)
        profiles.of_instance.push_back(description_.materials[record.material].profile);
    return profiles;
}

Rgb Scene::profile_at(std::int32_t profile, std::uint32_t instance, float time, Vec3f away) const {
    const InstanceRecord& record = records_[instance];
    const LampAxes axes(record.changes() ? record.where(time).world_from_local : record.still.world_from_local);
    return description_.profiles[std::size_t(profile)]->at(axes.local(away));
}

Spectrum Scene::uneven_radiance(const LightSample& sample, float time, const Wavelengths& wavelengths) const {
    if (sample.light == LightSet::kEnvironment) return lights_.environment_radiance(sample.wi, time, wavelengths);
    return wavelengths.emission(triangle_emission(sample.light, sample.barycentric, -sample.wi, time));
}

Rgb Scene::triangle_emission(std::size_t index, Vec2f barycentric, Vec3f toward, float time,
                             float width) const {
    const TriangleLight light = *lights_.triangle_at(index, time);
    const InstanceRecord& record = records_[light.instance];
    const Vec3f winding = cross(light.b - light.a, light.c - light.a);
    const bool front = (dot(winding, toward) > 0) != light.mirrored;
    const MaterialAt material = material_at(record.material, time);
    const Rgb all = emission_at(record, material, description_.textures,
                                {light.primitive, barycentric, front, time}, toward, width);
    const std::int32_t profile = static_cast<const Material&>(material).profile;
    return profile < 0 ? all : all * profile_at(profile, light.instance, time, toward);
}

bool Scene::is_uneven(const EmissionPoint& point) const {
    if (point.light == EmissionPoint::kSky) return false;
    const auto* triangle = std::get_if<TriangleLight>(&lights_.lights()[point.light]);
    return triangle && !triangle->even;
}

Rgb Scene::emission(const EmissionPoint& point, Vec3f toward, float time, float width) const {
    if (point.light == EmissionPoint::kSky)
        return lights_.environment()->luminance(point.position, time);
    const auto* triangle = std::get_if<TriangleLight>(&lights_.lights()[point.light]);
    if (!triangle) {
        if (dot(point.normal, toward) <= 0) return {0, 0, 0};   // blocked by the ball itself
        const SphereLight now = lights_.sphere_light_at(point.light, time);
        return now.luminance * lights_.shaped(now, toward);
    }
    if (!triangle->even || lights_.moves(point.light))
        return triangle_emission(point.light, point.barycentric, toward, time, width);
    if (!triangle->two_sided && dot(point.normal, toward) <= 0) return {0, 0, 0};
    return triangle->mean_luminance;
}

Scene::Leaving Scene::leave(const EmissionRay& emitted, float time) const {
    Leaving out{{.origin = emitted.origin, .direction = emitted.direction, .time = time},
                emitted.value};
    if (emitted.light == LightSet::kEnvironment) return out;
    const Light& light = lights_.lights()[emitted.light];
    if (const auto* triangle = std::get_if<TriangleLight>(&light)) {
        PlacementRoom made;
        SurfaceHit hit;
        const InstanceRecord& record = records_[triangle->instance];
        surface_at(record, record.placement(time, made), triangle->primitive, emitted.barycentric.x,
                   emitted.barycentric.y, hit);
        out.ray = spawn_ray(hit, emitted.direction, time);
        out.value = triangle_emission(emitted.light, emitted.barycentric, emitted.direction, time);
    } else if (std::holds_alternative<SphereLight>(light)) {
        const Sphere ball = lights_.sphere_light_at(emitted.light, time).shape;
        const Vec3f c = ball.center;
        const float largest = largest_coordinate(c) + ball.radius;
        out.ray.origin += (emitted.origin - c) * (0x1p-18f * largest / ball.radius);
    }
    return out;
}

}  // namespace dg
