// ghost_map_nodes.h -- nodes of a ghost's map over a cell and over wavelengths.
#pragma once
#include <array>

#include "render/flare/maps/ghost_map.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Chebyshev nodes of the wavelength in 1 / lambda^2, scaled to [-1, 1].
inline constexpr float kLambdaStep = 0.8660254f;

std::array<float, GhostMap::kSide> cubic_weights(float u);
float lambda_node(int k);   // nm

/// Weights of a cell's corners for a quantity that is 0 at its center: bilinear with a correction.
inline std::array<float, 4> corner_weights(Vec2f u) {
    const Vec2f from{u.x - 0.5f, u.y - 0.5f};
    const float bend = 0.25f * (2 * (from.x * from.x + from.y * from.y) - 1);
    return {(1 - u.x) * (1 - u.y) + bend, u.x * (1 - u.y) + bend, (1 - u.x) * u.y + bend, u.x * u.y + bend};
}

/// Position among the nodes of the transmittance.
inline float spectrum_place(float nm) {
    return (nm - kMinWavelength) * (GhostMap::kSpectrum - 1) / (kMaxWavelength - kMinWavelength);
}
inline float spectrum_node(float k) {
    return kMinWavelength + k * (kMaxWavelength - kMinWavelength) / (GhostMap::kSpectrum - 1);
}

}  // namespace dg
