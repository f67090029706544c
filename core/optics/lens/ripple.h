// ripple.h -- grooves that grinding leaves in a surface: rings around its vertex, a few
// nanometres high, that show as onion rings in discs of blur. The normal follows the slope
// of a band-limited height; the height itself is nothing. Source: Joo, Kwon, Lee,
// Eisemann, Lee 2016, Efficient Ray Tracing Through Aspheric Lenses and Imperfect Bokeh
// Synthesis, CGF 35(4).
#pragma once
#include <algorithm>
#include <vector>

namespace dg {

struct Ripple {
    double rms_nm = 0;     // of the height; 0: polished
    double period_um = 0;  // of the grooves: waves of within half an octave around it
    unsigned seed = 0;     // which grooves; the same ones for the same seed
};

/// dh/dr by radius, between steps linear.
struct RippleSlope {
    std::vector<float> slope;  // empty: none
    double steps_per_mm = 0;

    RippleSlope() = default;
    RippleSlope(const Ripple& ripple, double semi_diameter);

    double at(double r) const {
        const double x = std::min(r * steps_per_mm, double(slope.size()) - 1.001);
        const std::size_t i = std::size_t(x);
        return slope[i] + (x - double(i)) * (slope[i + 1] - slope[i]);
    }
};

}  // namespace dg
