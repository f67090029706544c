// scene.h -- instances (mesh + transform + material) and lights; immutable once built.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/hit.h"
#include "geometry/intersector.h"
#include "light/light.h"
#include "material/material.h"

namespace dg {

struct Instance {
    std::string name;
    std::uint32_t mesh, material;
    Affine3f world_from_local;
};

/// What a scene is built from. Lights made of meshes are found by Scene::build from the materials.
struct SceneDescription {
    std::vector<Mesh> meshes;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Instance> instances;
    std::vector<Light> lights;                 // punctual and sphere lights
    std::optional<Environment> environment;
};

class Scene {
  public:
    /// Validates (indices, NaN, singular transforms: Error names the part), finds emissive triangles,
    /// builds the intersector and the light set.
    static std::shared_ptr<const Scene> build(SceneDescription description);

    /// Nearest surface. Sphere lights come back with sphere_light >= 0 and only position and t set.
    struct Hit { SurfaceHit surface; std::int64_t sphere_light = -1; };
    std::optional<Hit> intersect(const Ray& ray) const;
    bool occluded(Vec3f from, Vec3f to_direction, float distance, float time) const;

    const Material& material(const SurfaceHit& hit) const;
    const std::vector<Texture>& textures() const;
    const LightSet& lights() const;
    /// Light sampling with textured emission resolved (see LightSample::triangle_light).
    std::optional<LightSample> sample_light(float u_select, Vec2f u, Vec3f position,
                                            const Wavelengths& wavelengths) const;

    struct Bounds { Vec3f min, max; };
    Bounds bounds() const;
    std::size_t triangle_count() const;       // instanced
    const SceneDescription& description() const;
    const char* intersector_name() const;
};

/// A ray that leaves `hit` along `wi`, its origin moved off the surface to the proper side.
Ray spawn_ray(const SurfaceHit& hit, Vec3f wi, float time);

}  // namespace dg
