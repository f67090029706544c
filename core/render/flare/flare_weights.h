// flare_weights.h -- how densely one emitter and ghost should be drawn, in all, over the front of the lens and
// over the wavelengths, as probes tell.
//
// The least noise for its time has what is drawn in proportion to the root of the mean square of what a path
// brings; and that counts relative to how bright the picture is where it lands.
#pragma once
#include <vector>

#include "render/flare/flare_probe.h"
#include "render/flare/flare_tiles.h"

namespace dg {

struct FlareWeights {
    int across;                       // cells of the probed rectangle, in either direction
    std::vector<float> cells;         // rows; none is 0
    std::vector<double> wavelengths;  // over [0, 1) of Wavelengths::at, of mean 1
    double sum = 0;                   // of the whole rectangle

    /// `spread`: over how many cells beside one it counts: those may be lit where no ray came.
    FlareWeights(const FlareFound& found, const FlareTiles& tiles, int across, int spread = 1);

  private:
    void weigh_wavelengths(const FlareFound& found, const FlareTiles& tiles);
    double square(const FlareFound::Hit& hit, const FlareTiles& tiles) const;
    double blurred(const std::vector<double>& squares, int row, int column, int spread) const;
};

}  // namespace dg
