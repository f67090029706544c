#include "scene/memory_need.h"

#include <algorithm>
#include <cstdio>

#include "math/error.h"

namespace dg {
namespace {

/// Whether a material emits at some time.
bool ever_emits(const SceneDescription& d, std::uint32_t material) {
    const auto found = d.material_keys.find(material);
    if (found == d.material_keys.end()) return emits(d.materials[material]);
    return std::ranges::any_of(found->second.values, emits);
}

std::string gigabytes(std::uint64_t bytes) {
    char words[32];
    std::snprintf(words, sizeof words, "%.3g GB", double(bytes) * 1e-9);
    return words;
}

}  // namespace

MemoryNeed::MemoryNeed(const SceneDescription& d) {
    for (const Mesh& mesh : d.meshes) {
        triangles += mesh.triangles.size();
        segments += mesh.curves.starts.size() * mesh.steps;
    }
    for (const Instance& instance : d.instances)
        if (ever_emits(d, instance.material)) lamps += d.meshes[instance.mesh].triangles.size();
}

void check_memory(const SceneDescription& d) {
    const MemoryNeed need(d);
    if (d.free_memory == 0 || need.bytes() <= d.free_memory) return;
    const std::string curves = need.segments == 0 ? ""
                                                  : ", " + std::to_string(need.segments) + " segments of curves of " +
                                                        std::to_string(MemoryNeed::kSegment);
    const std::string counted = std::to_string(need.triangles) + " triangles of " +
                                std::to_string(MemoryNeed::kTriangle) + " bytes" + curves + " and " +
                                std::to_string(need.lamps) +
                                " emissive ones of " + std::to_string(MemoryNeed::kLamp);
    throw input_error("memory", counted, "at most the " + gigabytes(d.free_memory) + " that are left",
                      gigabytes(need.bytes()));
}

}  // namespace dg
