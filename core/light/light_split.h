// light_split.h -- where a group of lights is cut in two.
#pragma once
#include <cstdint>
#include <span>

#include "light/light_bounds.h"

namespace dg {

/// A light while a tree is built.
struct LightItem {
    LightBounds bounds;
    Vec3f heading;      // mean of its normals, times intensity
    std::int32_t light;

    LightItem() = default;
    LightItem(const LightBounds& bounds, std::int32_t light);
};

/// Box and intensity of all together; no more of the bounds.
LightBounds box_of(std::span<const LightItem> lights);

/// Reorders the lights so that two groups follow each other, each small and shining one way as far as possible;
/// returns the size of the first (neither is empty). `room`: as many, to sort in. `halve`: by number.
std::size_t split_lights(std::span<LightItem> lights, std::span<LightItem> room, bool halve);

}  // namespace dg
