// memory_need.h -- memory that a scene takes when it is built, held against what there is.
#pragma once
#include "scene/scene.h"

namespace dg {

/// Numbers that a scene's memory goes by.
struct MemoryNeed {
    std::uint64_t triangles = 0;   // of the meshes, each once
    std::uint64_t segments = 0;    // of curves, each once for each of its time steps
    std::uint64_t lamps = 0;       // emissive triangles of all instances
    // Bytes of one at the peak, beside the arrays that the scene was given (bench/scale.py: triangles, lamps); segments:
    // strands of one segment with both ends.
    static constexpr std::uint64_t kTriangle = 50, kSegment = 260, kLamp = 400;

    explicit MemoryNeed(const SceneDescription& description);
    std::uint64_t bytes() const { return triangles * kTriangle + segments * kSegment + lamps * kLamp; }
};

/// Throws Error that names the memory that is needed, and what there is, where a scene cannot be built in it. The
/// indices of the description are valid.
void check_memory(const SceneDescription& description);

}  // namespace dg
