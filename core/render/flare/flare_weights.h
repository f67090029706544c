// flare_weights.h -- sampling weights of a pair of emitter and ghost, estimated from probes: total weight, cells of the
// front lens, and wavelengths.
//
// Sampling in proportion to the root mean square of a path's contribution minimizes noise per time. The contribution is
// taken relative to the brightness of the picture where the path lands.
#pragma once
#include <vector>

#include "render/flare/flare_probe.h"
#include "render/flare/flare_tiles.h"

namespace dg {

struct FlareWeights {
    int across;                       // cells along each axis of the probed rectangle
    std::vector<float> cells;         // row by row; all are positive
    std::vector<double> wavelengths;  // over [0, 1) of Wavelengths::at, of mean 1
    double sum = 0;                   // total weight of the rectangle

    /// `spread`: number of neighbouring cells over which hits are blurred, as cells without hits may receive light.
    FlareWeights(const FlareFound& found, const FlareTiles& tiles, int across, int spread = 1);

  private:
    void weigh_wavelengths(const FlareFound& found, const FlareTiles& tiles);
    double square(const FlareFound::Hit& hit, const FlareTiles& tiles) const;
    double blurred(const std::vector<double>& squares, int row, int column, int spread) const;
};

}  // namespace dg
