// mesh_patch.h -- a patch of a ghost's ray grid with bilinear interpolation between nodes. The dependence on wavelength
// and source point is constant over a patch.
#pragma once
#include <array>

#include "optics/trace/lens_tables.h"
#include "render/flare/maps/ghost_map.h"

namespace dg {

/// Dependence of a spectrum's light on the transmittance at the middle wavelength: a factor of
/// 1 + (transmittance - pass) per_pass.
struct GlassChange {
    float pass = 0, per_pass = 0;
};

struct MeshPatch {
    /// Fields that depend on wavelength and source point: px x, px y, beyond, and iris points. The transmittance of the
    /// glass at the middle wavelength follows them.
    static constexpr int kMostFields = 3 + 2 * kMostCrossings;
    static constexpr int pass_field(int crossings) { return 3 + 2 * crossings; }
    static constexpr int fields(int crossings) { return pass_field(crossings) + 1; }
    /// Differences from the middle wavelength to the nodes on either side (ghost_map_nodes.h), and from the center to
    /// the rim of the source along both axes.
    enum Set { kShort, kLong, kAcross, kDown, kSets };
    using Sets = std::array<std::array<float, kMostFields>, kSets>;

    const float* nodes = nullptr;   // first field of the first node
    int plane = 0, row = 0;         // strides of fields and of rows
    int squares = 1;                // along each axis
    int crossings = 1;
    Sets sets{};
    GlassChange glass{};

    /// Interpolates landings at the batch's points, [0, 1] over the patch: fills x, y, beyond, the iris and left.
    void land(const IrisTables& iris, MapBatch& batch, int count) const;
};

/// Writes the fields of a landing except the last, with the stride `plane`.
inline void put_fields(float* at, int plane, const MapLanding& l, int crossings) {
    at[0] = l.px.x, at[plane] = l.px.y, at[2 * plane] = l.beyond;
    for (int k = 0; k < crossings; ++k)
        at[(3 + 2 * k) * plane] = l.iris[std::size_t(k)].x, at[(4 + 2 * k) * plane] = l.iris[std::size_t(k)].y;
}

}  // namespace dg
