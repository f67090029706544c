// live_flare.h -- ghosts of the brightest small sources for interactive previews: redrawn for each picture in a tenth
// of a second, with errors of several percent. The front regions of ghosts are cached while the lens does not change
// (ghost_places.h). FlareSheets and the flare passes are the exact counterpart.
#pragma once
#include <cstddef>
#include <mutex>
#include <vector>

#include "render/flare/live/ghost_places.h"
#include "render/render.h"

namespace dg {

class LiveFlare {
  public:
    /// R, G and B of each pixel of the sensor, row by row. Uses sensor, shutter and threads of the settings. Throws
    /// Error for a lens that is not traced. Except for the first picture through a lens, which fills the cache, the
    /// result does not depend on earlier pictures. It is bit-identical for any number of threads.
    std::vector<float> draw(const Scene& scene, const Camera& camera, RenderSettings settings);

    struct Facts {
        int sources = 0;         // sources that light the lens; 0: the layer is black
        int ghosts = 0;          // drawn ghosts
        std::size_t rays = 0, arrivals = 0;
        std::size_t ray_arrivals = 0;   // arrivals by exact rays
    };
    /// Statistics of the last picture.
    const Facts& facts() const { return facts_; }

  private:
    std::mutex drawing_;
    GhostPlaces places_;
    Facts facts_;
};

}  // namespace dg
