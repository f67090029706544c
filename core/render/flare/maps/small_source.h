// small_source.h -- an emitter that the lens sees within so small an angle, wherever it goes while the shutter is open,
// that its ghosts are maps (ghost_map.h); with some of its points.
#pragma once
#include <optional>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/maps/map_rays.h"

namespace dg {

struct SmallSource {
    /// A point at a moment, as the source is drawn: the source is their mean.
    struct Point {
        Vec2f shift;
        Rgb light;           // that it brings to a unit of the square that holds the front
        Moment moment;
        EmitterPoint from;
    };

    int source;              // of the aim
    MapSource shape;
    std::vector<Point> points;
    bool moves;
    float filled;            // share of its circle that shines: 1 is an even disc, 0 a point or a line

    const Point& point(float u) const { return points[std::size_t(u * float(points.size()))]; }   // u in [0, 1)
    double luminance() const;
};

/// Nothing for one that is large, near or goes far, or is what other things reflect.
std::optional<SmallSource> small_source(const FlareAim& aim, int source);

}  // namespace dg
