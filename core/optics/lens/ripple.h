// ripple.h -- grinding marks: rings of grooves around a surface's vertex, a few nanometres high,
// which show as onion rings in discs of blur. The normal follows the slope of a band-limited height
// profile; the displacement is neglected. Source: Joo, Kwon, Lee, Eisemann, Lee 2016, Efficient Ray
// Tracing Through Aspheric Lenses and Imperfect Bokeh Synthesis, CGF 35(4).
#pragma once
#include <algorithm>
#include <vector>

namespace dg {

struct Ripple {
    double rms_nm = 0;     // height, root mean square; 0: polished
    double period_um = 0;  // mean period of the grooves; waves spread over half an octave to both sides
    unsigned seed = 0;     // random seed of the profile
};

/// Slope dh/dr over the radius, linear between equal steps.
struct RippleSlope {
    std::vector<float> slope;  // empty: polished
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
