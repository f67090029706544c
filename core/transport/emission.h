// emission.h -- emission that a path meets by following its BSDF, with the weight that multiple importance sampling and
// light paths leave to it. Each function includes the path's throughput.
#pragma once
#include "material/material.h"
#include "transport/walk/path_state.h"

namespace dg {

Spectrum sky_emission(const PathState& path);
Spectrum sphere_emission(const PathState& path, std::uint32_t sphere, const SurfaceHit& hit);
Spectrum surface_emission(const PathState& path, const Material& material, const SurfaceHit& hit);

}  // namespace dg
