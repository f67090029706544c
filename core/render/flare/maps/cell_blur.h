// cell_blur.h -- blur on the film by the size of a source, for the light and the edges of a ghost in a map cell.
//
// Light from the source point s that enters at u lands at F(u, s). The edge of a mount is the zero set of a clip
// function c(u, s). By implicit differentiation, its image on the film moves along its normal by (c_s - c_u F_u^-1 F_s)
// / |F_u^-T c_u|, and the image of the iris, with coordinates I(u, s), by F_s - F_u I_u^-1 I_s. So a ghost that images
// the iris sharply has sharp edges, even if rays of different source points land far apart.
#pragma once
#include <array>

#include "optics/lens/stop.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct CellRays {
    const MapLanding* nodes;   // GhostMap::kNodes landings from the center of the source
    const MapLanding* rim;     // two landings from the rim of the source along its axes, through the node kRimNode
    int crossings;
};
inline constexpr int kRimNode = 5;

struct CellBlur {
    float light = 0, edge = 0;   // px, from the center to the rim of the source; edge <= light
    /// Scales from clip values to distances from an edge: change of the clip function per px, and px per mm of the
    /// iris.
    float beyond_per_px = 0;
    std::array<float, kMostCrossings> px_per_mm{};
    float even_px = 0;           // distance over which the light changes e-fold; 0 at a caustic
};

/// `iris_radius`: mm. All blurs are 0 where rays are lost.
CellBlur cell_blur(const CellRays& rays, const Iris& iris, double iris_radius);

}  // namespace dg
