// camera_light.h -- light of a camera sample on its way to a pixel.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "spectrum/wavelengths.h"

namespace dg {

/// Part of a sample's coverage that is one object's, by any number.
struct ObjectCover {
    std::uint32_t object;
    float covered;
};

/// Light that one camera sample brings to one pixel, and how much of the pixel its objects cover. In a film with
/// catchers `light` is the objects' alone, beside what the set sends with them there and without.
struct CameraLight {
    Spectrum light{0.f}, with{0.f}, without{0.f};
    float white = 0;     // what a white world would bring: the weight of this sample's coverage
    float covered = 0;   // as much of it as objects cover
    static constexpr std::size_t kMostObjects = 4;
    std::array<ObjectCover, kMostObjects> objects{};   // the same by object, of the first
    std::size_t object_count = 0;
};

}  // namespace dg
