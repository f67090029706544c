// expose.h -- sensor model: from exposure to digital numbers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// Image of several planes, interleaved: row-major, planes per pixel.
struct Planes {
    const float* data;
    int width, height, count;
};

/// Sensor and shot. In electrons, except `gain` (DN per electron) and fields named DN.
struct Shot {
    int channels = 1;
    std::vector<float> electrons;      // electrons per unit of a plane in each channel: channels rows of
                                       // Planes::count
    int cell_width = 1, cell_height = 1;
    std::vector<std::uint8_t> cells;   // channel of each photosite of the repeating cell
    double low_pass_px = 0;            // distance of the two images along either axis
    double crosstalk = 0;              // fraction lost to the four neighbours
    double prnu = 0, dsnu = 0;         // standard deviations of response and offset
    double dark = 0;                   // mean dark electrons during the exposure
    double hot_share = 0, hot_dark = 0;   // fraction of hot photosites, and their mean dark electrons
    double full_well = 1;
    double read_noise = 0;
    double gain = 1;
    int black_dn = 0, highest_dn = 1;
    std::uint64_t serial = 0;   // of the sensor: seed of its fixed pattern
    std::uint64_t seed = 0;     // of the shot: seed of all other noise
};

struct Exposed {
    std::vector<std::uint16_t> mosaic;    // DN
    std::vector<std::uint8_t> saturated;  // 1: full well reached, or highest DN
    std::int64_t negative = 0;            // photosites with negative light, clamped to 0
    std::int64_t bad = 0;                 // photosites with non-finite light
    int bad_x = -1, bad_y = -1;           // first of these
};

/// Exposes the sensor. The low-pass filter acts on light before the mosaic, crosstalk on the
/// expected electrons after it, noise last on each photosite. Both mirror at the edges, so that
/// sums are preserved. The noise of a photosite depends only on its position, seed and serial
/// number. Order of the steps: EMVA Standard 1288, release 4.0 Linear (2021), 2.1 to 2.4 and 4.
Exposed expose(const Planes& light, const Shot& shot);

/// Expected photoelectrons without noise, dark current and clipping: the contribution of an
/// additional exposure.
std::vector<float> expected_electrons(const Planes& light, const Shot& shot);

}  // namespace dg
