// ghost_grid.h -- finds the part of the front through which a ghost of a small source reaches the frame, with a grid of
// rays from the source's center.
#pragma once
#include <optional>
#include <vector>

#include "render/flare/live/ghost_place.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct GhostGrid {
    static constexpr int kSquares = 16, kSide = kSquares + 1;   // along each axis

    FlareRectangle region;             // rectangle of the front's square
    std::vector<MapLanding> nodes;     // row by row; empty: no light reaches the frame
    std::vector<bool> lit;             // squares through which light may enter
    std::size_t rays = 0;              // number of rays traced

    /// `reach`: margin around the frame, px. `known`: may be null.
    GhostGrid(const MapRays& rays, const Sensor& sensor, float reach, const KnownGhost* known);

    bool empty() const { return nodes.empty(); }
    /// Front point at a grid position, in squares.
    Vec2f at(Vec2f node) const { return region.at(node * (1 / float(squares))); }

    /// Whether the rays at the corners of a square are all blocked with clip values above their differences, or all
    /// land outside the frame. `side`: nodes per row.
    static bool is_dark(const MapRays& rays, const Sensor& sensor, float reach, const MapLanding* at, int side);

    static float middle_nm();

  private:
    struct Looks {
        const MapRays& rays;
        const Sensor& sensor;
        float reach;
        int hardly;     // least number of lit nodes; with fewer, positions between nodes are sampled
        double share;   // approximate share of the light of all ghosts
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

    int squares = kSquares;   // squares along each axis of the current grid
    float nearest = 0;        // smallest from_light() among its rays
    Vec2f nearest_at{};       // grid position of that ray, in squares
};

}  // namespace dg
