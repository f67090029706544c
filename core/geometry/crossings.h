// crossings.h -- the clear surfaces that a shadow ray went through on its way to a light.
#pragma once
#include <array>
#include <cstdint>

namespace dg {

/// Where a ray met the geometry; barycentrics as glTF and Embree have them: p = (1-u-v) a
/// + u b + v c. No normal: the scene computes it from the vertices, with the side that
/// the instance gives it.
struct RawHit {
    float t;
    float u, v;
    std::uint32_t instance;   // index into the instances; kSphere for sphere lights
    std::uint32_t primitive;  // triangle, or index of the sphere
    static constexpr std::uint32_t kSphere = 0xffffffffu;
};

/// Surfaces that light may go straight on through: none, a thin sheet that bends no ray, or the
/// boundary of a volume, which does.
enum class Clear : std::uint8_t { no, sheet, volume };

/// Filled by Intersector::occluded, in no order. A ray that meets more of them than there
/// is room for is blocked.
struct Crossings {
    static constexpr std::uint32_t kMost = 32;
    std::array<RawHit, kMost> hits;
    std::uint32_t count = 0;
    bool volumes;  // whether the boundaries of volumes are passed as well

    explicit Crossings(bool volumes)
        : volumes(volumes) {}  // the hits are left as they are

    /// False: this one stops the ray.
    bool add(Clear clear, const RawHit& hit) {
        const bool passes = clear == Clear::sheet || (clear == Clear::volume && volumes);
        if (!passes || count == kMost) return false;
        hits[count++] = hit;
        return true;
    }
};

}  // namespace dg
