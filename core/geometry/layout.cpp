// layout.cpp -- selection of instances to flatten into world space.
#include "geometry/layout.h"

namespace dg {

std::vector<bool> choose_flattened(const std::vector<Mesh>& meshes,
                                   const std::vector<InstanceGeometry>& instances,
                                   std::size_t limit) {
    std::vector<std::size_t> uses(meshes.size(), 0);
    for (const InstanceGeometry& i : instances) uses[i.mesh] += i.still();

    std::size_t shared = 0;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        if (uses[m] > 1) shared += uses[m] * meshes[m].triangles.size();
    }
    // All or nothing: flattening only the smaller instances was slower than either (a mixed top
    // level).
    std::vector<bool> flattened(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint32_t m = instances[i].mesh;
        const bool copied_large = meshes[m].triangles.size() > kCompactLimit &&
                                  !is_identity(instances[i].world_from_local);
        const bool fits = uses[m] == 1 ? !copied_large : shared <= limit;
        flattened[i] = fits && instances[i].still() && meshes[m].curves.empty();
    }
    return flattened;
}

std::size_t count_flattened(const std::vector<Mesh>& meshes,
                            const std::vector<InstanceGeometry>& instances,
                            const std::vector<bool>& flattened) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (flattened[i]) count += meshes[instances[i].mesh].triangles.size();
    }
    return count;
}

}  // namespace dg
