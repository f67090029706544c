// emitter_passes.h -- the passes that follow light from the emitters, as far as the settings ask for them.
#pragma once
#include "camera/inverse/pixel_cone.h"
#include "render/drawn_samples.h"
#include "render/light_weight.h"
#include "render/pass.h"

namespace dg {

/// Light straight to the lens and over surfaces, ghosts, and what the lens scatters. Error for ghosts or scatter of a
/// lens that is not traced. `weight` and `cone` (of camera samples) outlive the passes.
void add_emitter_passes(Passes& passes, const Picture& picture, const DrawnSamples& drawn,
                        const LightWeight& weight, const PixelCone& cone);

}  // namespace dg
