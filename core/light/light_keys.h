// light_keys.h -- lights with animated pose and brightness while the shutter is open.
#pragma once
#include <span>

#include "light/emitter.h"
#include "motion/keyed.h"

namespace dg {

/// Interpolates between two lights of the same kind: positions, colours, radii and angles linearly, directions along
/// the great circle at constant speed. A range that is infinite in only one of both stays constant until the next key.
Light blend(const Light& a, const Light& b, float share);

/// Throws Error that starts with `where`: for an invalid light, a key of another kind than the first, and triangles,
/// which move with their instance.
void check_keys(std::span<const Light> keys, const std::string& where);

/// Bounds of a light over all times; bounds of two neighbouring keys also hold between them. Intensity 0: never emits,
/// or is at infinity.
LightBounds bounds_over(const Keyed<Light>& keys);

/// Largest selection_weight over time of a light from infinity.
float brightest(const Keyed<Light>& directional);

/// Bounds of a moving triangle. `steps`: its positions over time; it rotates by less than a right angle between two
/// steps. `luminance`: its largest mean.
LightBounds bounds_over(std::span<const TriangleLight> steps, Rgb luminance);

}  // namespace dg
