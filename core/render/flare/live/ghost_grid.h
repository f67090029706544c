// ghost_grid.h -- the part of the front through which a ghost of a small source comes to the frame, and rays of the source's
// middle from a grid over it.
#pragma once
#include <optional>
#include <vector>

#include "render/flare/live/ghost_place.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct GhostGrid {
    static constexpr int kSquares = 16, kSide = kSquares + 1;   // across

    FlareRectangle region;             // of the square that holds the front
    std::vector<MapLanding> nodes;     // row by row; none: no light comes to the frame
    std::vector<bool> lit;             // squares through which light may come
    std::size_t rays = 0;              // that it took

    /// `reach`: px beside the frame that count. `known`: or null.
    GhostGrid(const MapRays& rays, const Sensor& sensor, float reach, const KnownGhost* known);

    bool empty() const { return nodes.empty(); }
    /// The place of a node, in squares, or of one between nodes.
    Vec2f at(Vec2f node) const { return region.at(node * (1 / float(squares))); }

    /// Rays at the corners of a square of nodes, `side` across, are all stopped, and by more than that changes from one to
    /// the next; or all land beside the frame.
    static bool is_dark(const MapRays& rays, const Sensor& sensor, float reach, const MapLanding* at, int side);

    static float middle_nm();

  private:
    struct Looks {
        const MapRays& rays;
        const Sensor& sensor;
        float reach;
        int hardly;     // nodes at which light was seen: fewer ask for a closer look
        double share;   // of the light of all ghosts, about
    };
    static bool passes(const Looks& by, const MapLanding& landing);
    int mark(const Looks& by);
    int look(const Looks& by, int across);
    bool close_in(float least);
    bool search();
    int find(const Looks& by);
    bool is_cut(const Looks& by) const;
    bool is_smooth() const;
    static float from_light(const Looks& by, const MapLanding& landing);

    int squares = kSquares;   // across, of the present look
    float nearest = 0;        // of its rays to passing
    Vec2f nearest_at{};       // in squares
};

}  // namespace dg
