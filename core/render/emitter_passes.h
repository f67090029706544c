// emitter_passes.h -- adds the passes that trace light from the emitters, if the settings enable them.
#pragma once
#include "camera/inverse/pixel_cone.h"
#include "render/drawn_samples.h"
#include "render/light_weight.h"
#include "render/pass.h"

namespace dg {

/// Adds light paths directly to the lens and over surfaces, ghosts, and scattering in the lens. Throws Error for ghosts
/// or scattering of a lens that is not traced. `weight` and `cone` (of camera samples) must outlive the passes.
void add_emitter_passes(Passes& passes, const Picture& picture, const DrawnSamples& drawn,
                        const LightWeight& weight, const PixelCone& cone);

}  // namespace dg
