// test_scenes.h -- for tests: small meshes, and scenes of a single object.
#pragma once
#include <map>

#include "geometry/layout.h"
#include "math/hash.h"
#include "scene/scene.h"

namespace dg {

inline Vec3f test_direction(int i) {
    const double z = 2 * hash_uniform(21, i) - 1, phi = 2 * kPiD * hash_uniform(22, i);
    const double r = std::sqrt(1 - z * z);
    return {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
}

inline Ray test_ray(Vec3f origin, Vec3f direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = normalize(direction);
    return ray;
}

/// Whether a shadow ray to an area light is occluded.
inline bool occluded(const Scene& scene, Vec3f from, Vec3f direction, float distance) {
    const Wavelengths wavelengths = Wavelengths::sample(0.5f);
    Ray ray = test_ray(from, direction);
    ray.t_max = distance;
    return scene.visibility(ray, false, {}, wavelengths).is_black();
}

/// A light sample with its radiance from textures.
inline std::optional<LightSample> sample_light(const Scene& scene, float u_select, Vec2f u, Vec3f position,
                                               const Wavelengths& wavelengths) {
    auto sample = scene.lights().sample(u_select, u, position, 0, wavelengths);
    if (sample) sample->radiance = scene.radiance(*sample, 0, wavelengths);
    return sample;
}

/// Adds an instance of a mesh without a transform, with a new material.
inline void add(SceneDescription& d, Mesh mesh, Material material) {
    const auto i = std::uint32_t(d.meshes.size());
    mesh.name = "mesh";
    d.meshes.push_back(std::move(mesh));
    d.materials.push_back(std::move(material));
    d.instances.push_back({"it", i, i, {}});
}

/// Quad [-1,1]^2 at z = 0, facing +z, with u along +x and v along -y.
inline Mesh quad_mesh() {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

/// The cube [-1,1]^3, with outward winding.
inline Mesh cube_mesh() {
    Mesh mesh;
    mesh.name = "cube";
    mesh.positions = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}};
    mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 7, 6}, {4, 5, 7}, {0, 5, 4}, {0, 1, 5},
                      {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 7, 5}, {1, 3, 7}};
    return mesh;
}

/// The unit ball, an octahedron subdivided `levels` times, with outward winding.
inline Mesh ball_mesh(int levels) {
    Mesh mesh;
    mesh.name = "ball";
    std::vector<Vec3f> positions{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace(std::minmax(a, b), positions.size());
            if (fresh) positions.push_back(normalize(positions[a] + positions[b]));
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (auto [a, b, c] : mesh.triangles) {
            const std::uint32_t x = middle(a, b), y = middle(b, c), z = middle(c, a);
            finer.insert(finer.end(), {{a, x, z}, {b, y, x}, {c, z, y}, {x, y, z}});
        }
        mesh.triangles = finer;
    }
    mesh.positions = positions;
    return mesh;
}

inline SceneDescription describe(Mesh mesh, GltfMaterial material) {
    SceneDescription d;
    d.meshes = {std::move(mesh)};
    d.materials = {{"material", std::move(material)}};
    d.instances = {{"it", 0, 0, {}}};
    return d;
}

/// Adds distant instances until the mesh is no longer flattened.
inline void add_crowd(SceneDescription& d) {
    Instance far_away = d.instances[0];
    far_away.world_from_local = {};
    far_away.world_from_local.origin = {1e7f, 1e7f, 1e7f};
    d.instances.resize(kFlattenLimit / d.meshes[0].triangles.size() + 2, far_away);
}

/// A white texture in the slots that make uv and tangents needed.
inline void use_textures(SceneDescription& d) {
    d.textures.push_back({"white", 1, 1, 3, std::vector<std::uint8_t>{255, 255, 255}});
    auto& m = std::get<GltfMaterial>(d.materials[0].kind);
    m.normal_texture.index = m.base_color_texture.index = int(d.textures.size()) - 1;
}

}  // namespace dg
