// emission.h -- emission that a camera path hits by BSDF sampling, weighted by MIS against light sampling and against
// light paths. The returned values include the path's throughput.
#pragma once
#include "material/material.h"
#include "transport/walk/path_state.h"

namespace dg {

Spectrum sky_emission(const PathState& path);
Spectrum sphere_emission(const PathState& path, std::uint32_t sphere, const SurfaceHit& hit);
Spectrum surface_emission(const PathState& path, const Material& material, const SurfaceHit& hit);

}  // namespace dg
