// layers.h -- the layers of a film. To add a layer (a light group, a cell of the pupil):
//   1. its name in Layer (film_layout.h);
//   2. its row in kLayers below, at the same place: the record of a pixel, with add() to merge (records.h), and the most
//      records that a pixel may have;
//   3. the line that adds samples, in film_add.cpp.
// From its row a layer has memory, limits, merging, its part of checkpoints, passes and messages of the cluster, a keyword
// of Python's FilmLayout, and, if its record has values(), Film.means(). Files of films without the layer stay the same.
#pragma once
#include <tuple>

#include "film/film_layout.h"
#include "film/plane.h"
#include "film/records.h"
#include "spectrum/responses.h"

namespace dg {

template <class S>
struct LayerRow {
    using Store = S;   // Plane of records, or ObjectLists
    Layer layer;
    const char* name;                             // in files, messages and Python
    const char* about;                            // docstring in Python; null: the layer follows from other layers
    int most;                                     // largest count that a layout may ask for
    int (*per_pixel)(const LayerCounts&) = nullptr;   // records per pixel; null: the count of the layout
    Layer needs = Layer::sums;                    // layer that a layout must also ask for

    constexpr int records(const LayerCounts& asked) const { return per_pixel ? per_pixel(asked) : asked[layer]; }
};

inline constexpr std::tuple kLayers{
    LayerRow<Plane<CameraSums>>{Layer::sums, "sums", nullptr, 0, [](const LayerCounts&) { return 1; }},
    LayerRow<Plane<AovSums>>{Layer::aovs, "aovs", "Auxiliary channels, FILM_AOVS.", 1},
    LayerRow<Plane<ColorSums>>{Layer::splats, "splats", "Light paths may add to any pixel.", 1},
    LayerRow<Plane<ColorSums>>{Layer::flare, "flare", "Ghosts may add to any pixel.", 1},
    LayerRow<Plane<HalfSums>>{Layer::halves, "halves", "Sums of the samples with even indices, for noise.", 1},
    LayerRow<Plane<CoverageSums>>{Layer::coverage, "coverage", "Share of each pixel that objects cover.", 1},
    // Two records per pixel: light of catchers and background with the objects, and without.
    LayerRow<Plane<XyzSums>>{Layer::catchers, "catchers", "Light of catchers, with and without the objects.", 1,
                             [](const LayerCounts& asked) { return 2 * asked[Layer::catchers]; }},
    LayerRow<Plane<ValueSum>>{Layer::bands, "bands", "Bands of equal width over all wavelengths.", 64},
    LayerRow<Plane<ValueSum>>{Layer::channels, "channels", "Channels of a sensor (Film.set_responses).",
                              Responses::kMost},
    // Channels of splats and flare, separate from camera samples so that splats lock rows of pixels and not each pixel.
    LayerRow<Plane<ValueSum>>{Layer::channel_splats, "channel_splats", nullptr, 0,
                              [](const LayerCounts& asked) {
                                  return asked[Layer::splats] || asked[Layer::flare] ? asked[Layer::channels] : 0;
                              }},
    LayerRow<Plane<ValueSum>>{Layer::catcher_channels, "catcher_channels", nullptr, 0,
                              [](const LayerCounts& asked) {
                                  return 2 * asked[Layer::catchers] * asked[Layer::channels];
                              }},
    LayerRow<ObjectLists>{Layer::objects, "objects", "Share of each pixel that each object covers.", 1, nullptr,
                          Layer::coverage},
};

}  // namespace dg
