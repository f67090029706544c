// truth_channels.h -- the channels of ground truth; defines their names and order in files and in Python.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "render/truth/truth.h"

namespace dg {

/// A channel with one value per pixel: a length, a component, or an ID.
struct TruthChannel {
    const char* name;
    std::variant<float (*)(const TruthPlanes&, std::size_t pixel),
                 std::uint32_t (*)(const TruthPlanes&, std::size_t pixel)>
        value;
};

inline const std::array kTruthChannels{
    TruthChannel{"depth.Z", [](const TruthPlanes& t, std::size_t i) { return t.depth[i]; }},
    TruthChannel{"distance.Z", [](const TruthPlanes& t, std::size_t i) { return t.distance[i]; }},
    TruthChannel{"P.X", [](const TruthPlanes& t, std::size_t i) { return t.position[i].x; }},
    TruthChannel{"P.Y", [](const TruthPlanes& t, std::size_t i) { return t.position[i].y; }},
    TruthChannel{"P.Z", [](const TruthPlanes& t, std::size_t i) { return t.position[i].z; }},
    TruthChannel{"N.X", [](const TruthPlanes& t, std::size_t i) { return t.normal[i].x; }},
    TruthChannel{"N.Y", [](const TruthPlanes& t, std::size_t i) { return t.normal[i].y; }},
    TruthChannel{"N.Z", [](const TruthPlanes& t, std::size_t i) { return t.normal[i].z; }},
    TruthChannel{"object_id", [](const TruthPlanes& t, std::size_t i) { return t.object_id[i]; }},
    TruthChannel{"material_id", [](const TruthPlanes& t, std::size_t i) { return t.material_id[i]; }},
};

/// Channel of MeanTruth::coverage, which exists only for means.
inline constexpr const char* kCoverageChannel = "coverage.Y";

}  // namespace dg
