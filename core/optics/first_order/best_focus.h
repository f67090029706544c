// best_focus.h -- film position with the smallest spot, as opposed to the paraxial focus.
#pragma once
#include <vector>

#include "optics/first_order/paraxial.h"

namespace dg {

struct WeightedWavelength {
    double nm, weight;
};

/// F, d and C lines, weighted by the eye's sensitivity (CIE 1924 V).
inline const std::vector<WeightedWavelength> kEyeWavelengths = {
    {486.1327, 0.181}, {587.5618, 0.783}, {656.2725, 0.072}};

struct BestFocus {
    double film_z;  // mm, lens frame
    double rms;     // mm, radius of the spot: root mean square distance from its centre
};

/// Film position with the smallest RMS spot of a point on the axis at a distance in m (may be
/// infinite). Traces exact rays through equal areas of the entrance pupil, clipped by the iris and
/// all clear apertures. The mean square is quadratic in z, so the minimum is exact. Throws Error if
/// no ray passes.
BestFocus best_focus(const Prescription& lens, double f_stop, double distance_m,
                     FocusFrom from = FocusFrom::pupil,
                     const std::vector<WeightedWavelength>& wavelengths = kEyeWavelengths);

}  // namespace dg
