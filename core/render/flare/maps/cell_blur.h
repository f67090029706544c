// cell_blur.h -- how far the size of a source blurs what a cell of a ghost's map brings: its light, and its edges.
//
// With the source's point s, light that enters at u lands at F(u, s); where the edge of a mount is, a clip function c(u, s)
// is 0. On the film that edge moves, along its normal, by (c_s - c_u F_u^-1 F_s) / |F_u^-T c_u|; that of the iris, of which
// I(u, s) is the image, with F_s - F_u I_u^-1 I_s. So a ghost that shows the iris sharply has sharp edges, though each of
// its points is lit by rays that land far from each other: derivatives of a function that is given implicitly.
#pragma once
#include <array>

#include "optics/lens/stop.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct CellRays {
    const MapLanding* nodes;   // GhostMap::kNodes of them, of the middle of the source
    const MapLanding* rim;     // two, from its rim along either axis, through the node kRimNode
    int crossings;
};
inline constexpr int kRimNode = 5;

struct CellBlur {
    float light = 0, edge = 0;   // px, from the middle to the rim; the edge's is no wider than the light's
    /// How far a place of the film is from an edge: what the clip function changes over a px, and px for each mm of the
    /// iris.
    float beyond_per_px = 0;
    std::array<float, kMostCrossings> px_per_mm{};
    float even_px = 0;           // over which the light changes e-fold; 0: it folds
};

/// `iris_radius`: mm. Sharp (0) where rays are lost.
CellBlur cell_blur(const CellRays& rays, const Iris& iris, double iris_radius);

}  // namespace dg
