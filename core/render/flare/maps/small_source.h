// small_source.h -- an emitter of so small an angular size, including its motion while the shutter is open, that maps
// can represent its ghosts (ghost_map.h); with samples of its points.
#pragma once
#include <optional>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct SmallSource {
    /// A sampled point at a time. The source is the mean of its points.
    struct Point {
        Vec2f shift;
        Rgb light;           // illuminance on the square that bounds the front
        Moment moment;
        EmitterPoint from;
    };

    int source;              // index of the aim's source
    MapSource shape;
    std::vector<Point> points;
    bool moves;
    float filled;            // lit fraction of its circle: 1 for a uniform disc, 0 for a point or a line

    const Point& point(float u) const { return points[std::size_t(u * float(points.size()))]; }   // u in [0, 1)
    double luminance() const;
};

/// Empty if the source is large, near, moves far, or is a reflection.
std::optional<SmallSource> small_source(const FlareAim& aim, int source);

}  // namespace dg
