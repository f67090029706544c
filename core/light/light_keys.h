// light_keys.h -- lights that move, turn and dim while the shutter is open.
#pragma once
#include <span>

#include "light/emitter.h"
#include "motion/keyed.h"

namespace dg {

/// `share` of the way from a to b, which are of one kind: positions, colours, radii and angles go
/// straight, directions along the great circle at constant speed. A range that is infinite at one
/// end only stays as it is until the next key.
Light blend(const Light& a, const Light& b, float share);

/// Throws Error that starts with `where`: a key that is no light, or of another kind than the
/// first; triangles, which move with their instance.
void check_keys(std::span<const Light> keys, const std::string& where);

/// Where the light may be and shine at some time: what holds at two neighbouring keys holds between
/// them. Intensity 0: it never shines, or is at infinity.
LightBounds bounds_over(const Keyed<Light>& keys);

/// The brightest that the light from infinity ever is, by selection_weight.
float brightest(const Keyed<Light>& directional);

/// Bounds of a triangle that moves. `steps` are its places one after the other; between two of them
/// it turns by less than a right angle. `luminance` is the largest mean that it has.
LightBounds bounds_over(std::span<const TriangleLight> steps, Rgb luminance);

}  // namespace dg
