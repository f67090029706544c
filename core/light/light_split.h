// light_split.h -- splits a group of lights for the light tree.
#pragma once
#include <cstdint>
#include <span>

#include "light/light_bounds.h"

namespace dg {

/// A light during construction of the tree.
struct LightItem {
    LightBounds bounds;
    Vec3f heading;      // mean normal times intensity
    std::int32_t light;

    LightItem() = default;
    LightItem(const LightBounds& bounds, std::int32_t light);
};

/// Box and total intensity of lights; other bounds are not set.
LightBounds box_of(std::span<const LightItem> lights);

/// Partitions the lights into two nonempty groups that are compact in position and direction; returns the size of the
/// first. `room`: buffer of the same size. `halve`: splits by number.
std::size_t split_lights(std::span<LightItem> lights, std::span<LightItem> room, bool halve);

}  // namespace dg
