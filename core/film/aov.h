// aov.h -- auxiliary values of a camera sample, and the one list of their channels: film, files and
// Python take names and order from it. One row adds a channel (and changes the size of pass files).
#pragma once
#include <array>
#include <cstdint>

#include "math/vec.h"

namespace dg {

/// Auxiliary values at the first hit of a camera sample. Samples that the lens vignettes have none.
struct AovSample {
    bool hit = false;
    float depth = 0;  // m, along the camera's -z
    Vec3f position, normal, albedo;
    std::uint32_t object_id = 0;  // instance index + 1; 0: no hit
    Vec3f guide_albedo{}, guide_normal{};   // denoiser guides, seen through mirrors and glass; 0: no hit
};

struct AovChannel {
    const char* name;   // as in files
    bool of_hits;       // whether the mean is over samples with a hit; else over all samples that passed the lens
    float (*value)(const AovSample&);
};

inline constexpr std::array kAovChannels{
    AovChannel{"depth.Z", true, [](const AovSample& s) { return s.depth; }},
    AovChannel{"P.X", true, [](const AovSample& s) { return s.position.x; }},
    AovChannel{"P.Y", true, [](const AovSample& s) { return s.position.y; }},
    AovChannel{"P.Z", true, [](const AovSample& s) { return s.position.z; }},
    AovChannel{"N.X", true, [](const AovSample& s) { return s.normal.x; }},
    AovChannel{"N.Y", true, [](const AovSample& s) { return s.normal.y; }},
    AovChannel{"N.Z", true, [](const AovSample& s) { return s.normal.z; }},
    AovChannel{"albedo.R", false, [](const AovSample& s) { return s.albedo.x; }},
    AovChannel{"albedo.G", false, [](const AovSample& s) { return s.albedo.y; }},
    AovChannel{"albedo.B", false, [](const AovSample& s) { return s.albedo.z; }},
    // Means over all samples that passed the lens, as in the picture: guides have the same defocus and motion blur, and
    // edges fade into the sky.
    AovChannel{"denoise_albedo.R", false, [](const AovSample& s) { return s.guide_albedo.x; }},
    AovChannel{"denoise_albedo.G", false, [](const AovSample& s) { return s.guide_albedo.y; }},
    AovChannel{"denoise_albedo.B", false, [](const AovSample& s) { return s.guide_albedo.z; }},
    AovChannel{"denoise_normal.X", false, [](const AovSample& s) { return s.guide_normal.x; }},
    AovChannel{"denoise_normal.Y", false, [](const AovSample& s) { return s.guide_normal.y; }},
    AovChannel{"denoise_normal.Z", false, [](const AovSample& s) { return s.guide_normal.z; }},
};

}  // namespace dg
