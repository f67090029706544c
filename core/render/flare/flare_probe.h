// flare_probe.h -- exact rays from one source by one ghost, over a part of the front lens: what of them comes to
// the frame.
#pragma once
#include <limits>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/flare_cells.h"

namespace dg {

struct FlareProbe {
    int source, ghost;
    int count;
    FlareRectangle where{};
    const Distribution2D* cells = nullptr;   // by which it is drawn; null: evenly
    int first = 0;                           // ray, of those that there are
};

struct FlareFound {
    /// A ray that came to the frame. Light is what the part brings to the film if all of it is like this ray, at
    /// all wavelengths: its luminance, and the root mean square of R, G and B, which is what is noise.
    struct Hit {
        Vec2f at, px;
        float lambda;   // in [0, 1), as of Wavelengths::at
        float luminance, rgb;
        float share;    // of the part that it stands for
    };
    FlareProbe probe{};
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};   // of the hits, on the front
    std::vector<Hit> hits{};
    /// The nearest to the frame of the rays that came to the film's plane beside it.
    Vec2f near_at{};
    float near_px = std::numeric_limits<float>::infinity();

    /// Adds a probe of the same source over the same part; shares are as they were.
    void add(const FlareFound& other);
    /// Makes shares those of so many rays in each cell, rows of across x across.
    void share(const std::vector<double>& rays, int across);
    /// Hits of another look are to be held as well.
    void reach(const FlareFound& other);
    /// A larger rectangle, at the sides where hits lie in the last of so many cells; within the square.
    FlareRectangle grown(int across) const;
    /// A rectangle that holds what was found to let light in, and as much around it as the rays may have missed.
    FlareRectangle narrowed() const;
};

/// Cell of across x across of a rectangle, in rows.
std::size_t cell_of(const FlareRectangle& where, Vec2f at, int across);

FlareFound probe_flare(const FlareAim& aim, const FlareProbe& probe);

}  // namespace dg
