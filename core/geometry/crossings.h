// crossings.h -- clear surfaces crossed by a shadow ray on its way to a light.
#pragma once
#include <array>
#include <cstdint>

namespace dg {

/// Hit of a ray on the geometry; barycentrics as in glTF and Embree: p = (1-u-v) a + u b + v c. The
/// scene computes the normal from the vertices, oriented by the instance's transform.
struct RawHit {
    float t;
    float u, v;
    std::uint32_t instance;   // index of the instance; kSphere for sphere lights
    std::uint32_t primitive;  // index of the triangle or sphere
    static constexpr std::uint32_t kSphere = 0xffffffffu;
};

/// Surfaces that light may pass in a straight line: none, a thin sheet without refraction, or the
/// boundary of a volume.
enum class Clear : std::uint8_t { no, sheet, volume };

/// Filled by Intersector::occluded, unordered. A ray that crosses more than kMost surfaces counts
/// as blocked.
struct Crossings {
    static constexpr std::uint32_t kMost = 32;
    std::array<RawHit, kMost> hits;
    std::uint32_t count = 0;
    bool volumes;  // whether boundaries of volumes are passed too

    explicit Crossings(bool volumes)
        : volumes(volumes) {}  // leaves the hits uninitialized

    /// Returns false if the surface blocks the ray.
    bool add(Clear clear, const RawHit& hit) {
        const bool passes = clear == Clear::sheet || (clear == Clear::volume && volumes);
        if (!passes || count == kMost) return false;
        hits[count++] = hit;
        return true;
    }
};

}  // namespace dg
