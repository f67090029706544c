// expose.h -- from the exposure of a film to the numbers that a sensor reads.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// A picture of several planes, interleaved: row by row, pixel by pixel.
struct Planes {
    const float* data;
    int width, height, count;
};

/// The sensor and the shot. Electrons, but for `gain` (DN per electron) and what is in DN by name.
struct Shot {
    int channels = 1;
    std::vector<float> electrons;      // of a plane's 1 in each channel: channels rows of Planes::count
    int cell_width = 1, cell_height = 1;
    std::vector<std::uint8_t> cells;   // channel of each photosite of the cell that repeats
    double low_pass_px = 0;            // distance of the two images along either axis
    double crosstalk = 0;              // share that the four neighbours get
    double prnu = 0, dsnu = 0;         // standard deviations of response and offset
    double dark = 0;                   // mean during this exposure
    double hot_share = 0, hot_dark = 0;   // of the photosites, and the mean of theirs
    double full_well = 1;
    double read_noise = 0;
    double gain = 1;
    int black_dn = 0, highest_dn = 1;
    std::uint64_t serial = 0;   // of the sensor: its fixed pattern
    std::uint64_t seed = 0;     // of the shot: everything else
};

struct Exposed {
    std::vector<std::uint16_t> mosaic;    // DN
    std::vector<std::uint8_t> saturated;  // 1: the well was full, or the number is the highest
    std::int64_t negative = 0;            // photosites whose light was below 0 and was taken for 0
    std::int64_t bad = 0;                 // whose light is not finite
    int bad_x = -1, bad_y = -1;           // the first of those
};

/// The low-pass filter acts on light, before the mosaic; crosstalk after it, on electrons that are expected;
/// noise last, on each photosite. What leaves at an edge comes back there, so that sums are kept. A
/// photosite's noise depends on its place, seed and serial number alone.
/// Source of the order: EMVA Standard 1288, release 4.0 Linear (2021), 2.1 to 2.4 and 4.
Exposed expose(const Planes& light, const Shot& shot);

/// Electrons that light makes on average, without noise, heat and limits: what another exposure has besides its own.
std::vector<float> expected_electrons(const Planes& light, const Shot& shot);

}  // namespace dg
