// test_furnace.h -- a closed cube for furnace tests, and the luminance of paths inside it.
#pragma once
#include "math/statistics.h"
#include "transport/path.h"

namespace dg {

/// Cube [-1, 1]^3 with front faces inward.
inline Mesh closed_cube() {
    Mesh cube;
    cube.name = "cube";
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    cube.positions = corners;
    cube.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    return cube;
}

/// Scene of the cube [-1, 1]^3, with the last of the materials.
inline std::shared_ptr<const Scene> cube_of(std::vector<Material> materials) {
    SceneDescription d;
    d.meshes.push_back(closed_cube());
    d.instances.push_back({"cube", 0, std::uint32_t(materials.size() - 1), {}});
    d.materials = std::move(materials);
    return Scene::build(std::move(d));
}

/// Luminances of n paths from the center in uniformly distributed directions.
inline SampleMoments look(const Scene& scene, const PathSettings& settings, int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
        PathSampler sampler(i % 64, i / 64, 0, 7);
        Wavelengths wavelengths = Wavelengths::sample(sampler.camera().lambda);
        const Vec2f u = sampler.next_2d();
        const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
        Ray ray;
        ray.direction = normalize(Vec3f{r * std::cos(phi), r * std::sin(phi), z});
        const Spectrum l = radiance(scene, ray, wavelengths, sampler, settings, nullptr, nullptr).sum();
        values.push_back(wavelengths.to_xyz(l).y);
    }
    return moments(values);
}

inline bool agrees(const SampleMoments& m, double expected) {
    return std::abs(m.mean - expected) < 4 * std::sqrt(m.variance / m.count) + 1e-3 * expected;
}

}  // namespace dg
