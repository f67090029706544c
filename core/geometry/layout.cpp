// layout.cpp -- which instances are copied into world space, and which are traced through a transform.
#include "geometry/layout.h"

#include <algorithm>
#include <numeric>

namespace dg {

std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit) {
    std::vector<std::size_t> uses(meshes.size(), 0);
    for (const InstanceGeometry& i : instances) ++uses[i.mesh];

    // All instances of a mesh are treated alike: while one of them needs the mesh's own tree, copies
    // of the others save nothing. What copying a mesh costs is uses * triangles.
    std::vector<std::size_t> order(meshes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    auto cost = [&](std::size_t m) { return uses[m] * meshes[m].triangles.size(); };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });

    std::vector<bool> flatten_mesh(meshes.size(), false);
    std::size_t total = 0;
    for (std::size_t m : order) {
        flatten_mesh[m] = uses[m] == 1 || total + cost(m) <= limit;
        if (flatten_mesh[m]) total += cost(m);
    }

    std::vector<bool> flattened(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        flattened[i] = flatten_mesh[instances[i].mesh];
    }
    return flattened;
}

}  // namespace dg
