// camera_light.h -- light of a camera sample on its way to a pixel.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "spectrum/wavelengths.h"

namespace dg {

/// Coverage of a sample by one object.
struct ObjectCover {
    std::uint32_t object;   // any number that identifies the object
    float covered;          // part of CameraLight::white
};

/// Light and coverage that a camera sample adds to a pixel. In a film with catchers, `light` is the light of the objects
/// alone; the two others are the light of catchers and background with the objects present and absent.
struct CameraLight {
    Spectrum light{0.f}, with_objects{0.f}, without_objects{0.f};
    float white = 0;     // weight of the sample: the light of a white world
    float covered = 0;   // part of `white` that objects cover
    static constexpr std::size_t kMostObjects = 4;
    std::array<ObjectCover, kMostObjects> objects{};   // `covered` split by object, for the first kMostObjects
    std::size_t object_count = 0;
};

}  // namespace dg
