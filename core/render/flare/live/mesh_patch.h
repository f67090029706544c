// mesh_patch.h -- squares of a grid of rays by a ghost: bilinear between nodes. Wavelength and point of the source change
// all landings of a patch alike.
#pragma once
#include <array>

#include "optics/trace/lens_tables.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// How light of a spectrum changes with the transmittance at the middle wavelength: by the factor
/// 1 + (transmittance - pass) per_pass.
struct GlassChange {
    float pass = 0, per_pass = 0;
};

struct MeshPatch {
    /// Fields that wavelengths and source change: px x, px y, beyond, and points of the iris. The transmittance of the
    /// glass at the middle wavelength is behind them.
    static constexpr int kMostFields = 3 + 2 * kMostCrossings;
    static constexpr int pass_field(int crossings) { return 3 + 2 * crossings; }
    static constexpr int fields(int crossings) { return pass_field(crossings) + 1; }
    /// Change from the middle wavelength to the nodes on either side (ghost_map_nodes.h), and to the source's rim along
    /// either axis.
    enum Set { kShort, kLong, kAcross, kDown, kSets };
    using Sets = std::array<std::array<float, kMostFields>, kSets>;

    const float* nodes = nullptr;   // of its first node, the first field
    int plane = 0, row = 0;         // from a field to the next, from a row to the next
    int squares = 1;                // across
    int crossings = 1;
    Sets sets{};
    GlassChange glass{};

    /// Where rays land that enter at a batch's places, [0, 1] across the patch: fills x, y, beyond, the iris and left.
    void land(const IrisTables& iris, MapBatch& batch, int count) const;
};

/// Sets the fields of a landing but the last, each `plane` behind the one before.
inline void put_fields(float* at, int plane, const MapLanding& l, int crossings) {
    at[0] = l.px.x, at[plane] = l.px.y, at[2 * plane] = l.beyond;
    for (int k = 0; k < crossings; ++k)
        at[(3 + 2 * k) * plane] = l.iris[std::size_t(k)].x, at[(4 + 2 * k) * plane] = l.iris[std::size_t(k)].y;
}

}  // namespace dg
