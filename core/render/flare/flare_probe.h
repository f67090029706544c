// flare_probe.h -- exact rays from a source through a ghost, over a part of the front lens; records rays that reach the
// frame.
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
    const Distribution2D* cells = nullptr;   // distribution of front points; null: uniform
    int first = 0;                           // index of the first ray in the sequence
};

struct FlareFound {
    /// A ray that reached the frame. Its light values extrapolate the ray to the whole probed part and to all
    /// wavelengths: luminance, and the root mean square of R, G and B, which measures noise.
    struct Hit {
        Vec2f at, px;
        float lambda;   // in [0, 1), as of Wavelengths::at
        float luminance, rgb;
        float share;    // fraction of the probed part that the ray represents
    };
    FlareProbe probe{};
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};   // bounds of the hits on the front
    std::vector<Hit> hits{};
    /// Front point of the ray that came nearest to the frame among the rays that reached the film plane outside it.
    Vec2f near_at{};
    float near_px = std::numeric_limits<float>::infinity();

    /// Adds a probe of the same source over the same part, without changing shares.
    void add(const FlareFound& other);
    /// Recomputes shares from the number of rays in each of across x across cells, row by row.
    void share(const std::vector<double>& rays, int across);
    /// Extends the bounds to the hits of another probe.
    void reach(const FlareFound& other);
    /// The rectangle, enlarged at sides with hits in the outermost of `across` cells, and clipped to the square.
    FlareRectangle grown(int across) const;
    /// Bounds of the hits with a margin for parts that the rays may have missed.
    FlareRectangle narrowed() const;
};

/// Index of the cell at a point, among across x across cells of a rectangle, row by row.
std::size_t cell_of(const FlareRectangle& where, Vec2f at, int across);

FlareFound probe_flare(const FlareAim& aim, const FlareProbe& probe);

}  // namespace dg
