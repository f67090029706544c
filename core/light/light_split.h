// light_split.h -- where a group of lights is cut in two.
#pragma once
#include <cstdint>
#include <span>

#include "light/light_bounds.h"

namespace dg {

/// Reorders the lights so that two groups follow each other, each small and shining one
/// way as far as possible; returns the size of the first (neither is empty). `halve`: by
/// number.
std::size_t split_lights(std::span<const LightBounds> lights,
                         std::span<std::int32_t> order, bool halve);

}  // namespace dg
