// live_source.h -- a small source as pictures that pass by draw it: its points, and its colours by bands of the wavelength.
#pragma once
#include <array>
#include <vector>

#include "render/flare/maps/small_source.h"

namespace dg {

struct LiveSource {
    static constexpr int kBands = 15, kFine = 16;   // steps of a band
    static constexpr int kGroups = 3;               // of bands, which land apart from each other
    SmallSource small;
    std::array<Rgb, kBands> colors;                 // of an arrival that is drawn in one of them
    std::vector<float> brightness;                  // of its points, over their mean
    float free;                                     // share of its light that nothing in the scene is in the way of
    double light;                                   // of that share

    LiveSource(SmallSource own, float free_share);
    /// u in [0, 1): its band is int(u * kBands).
    static float nm(float u);
    /// Shares of the change to the nodes on either side of the middle wavelength, by steps.
    static const std::array<Vec2f, kBands * kFine>& lambda_weights();
};

}  // namespace dg
