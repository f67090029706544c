// memory_need.h -- estimates the memory for building a scene, and compares it with the available memory.
#pragma once
#include "scene/scene.h"

namespace dg {

/// Numbers that determine a scene's memory.
struct MemoryNeed {
    std::uint64_t triangles = 0;   // of the meshes, each counted once
    std::uint64_t segments = 0;    // of curves, each counted once per time step
    std::uint64_t lamps = 0;       // emissive triangles of all instances
    // Peak bytes per item, without the input arrays (bench/scale.py: triangles, lamps); segments: measured with strands
    // of a single segment with both ends.
    static constexpr std::uint64_t kTriangle = 50, kSegment = 260, kLamp = 400;

    explicit MemoryNeed(const SceneDescription& description);
    std::uint64_t bytes() const { return triangles * kTriangle + segments * kSegment + lamps * kLamp; }
};

/// Throws Error that names the required and the available memory if a scene does not fit. Indices of the description
/// must be valid.
void check_memory(const SceneDescription& description);

}  // namespace dg
