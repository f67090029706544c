// live_flare.h -- ghosts of the brightest small sources for a picture that follows a hand: some per cent off, and drawn anew
// for each picture in a tenth of a second. Where ghosts come through the front is kept while the lens stays as it is
// (ghost_places.h). FlareSheets and the passes draw the same exactly.
#pragma once
#include <cstddef>
#include <mutex>
#include <vector>

#include "render/flare/live/ghost_places.h"
#include "render/render.h"

namespace dg {

class LiveFlare {
  public:
    /// Light, row by row, R, G and B of each pixel of the sensor. Of the settings: sensor, shutter and threads. Error for a
    /// lens that is not traced. The first picture through a lens finds its ghosts anew; all others have the same bits
    /// whatever was drawn before. The same bits on any number of threads.
    std::vector<float> draw(const Scene& scene, const Camera& camera, RenderSettings settings);

    struct Facts {
        int sources = 0;         // that shine on the lens; 0: all is black
        int ghosts = 0;          // that were drawn
        std::size_t rays = 0, arrivals = 0;
        std::size_t ray_arrivals = 0;   // arrivals that were rays of their own
    };
    /// Figures of the last picture.
    const Facts& facts() const { return facts_; }

  private:
    std::mutex drawing_;
    GhostPlaces places_;
    Facts facts_;
};

}  // namespace dg
