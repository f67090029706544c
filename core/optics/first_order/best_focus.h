// best_focus.h -- where the film sees the smallest spot, as against the paraxial focus.
#pragma once
#include <vector>

#include "optics/first_order/paraxial.h"

namespace dg {

struct WeightedWavelength {
    double nm, weight;
};

/// F, d and C by what the eye makes of them (CIE 1924 V).
inline const std::vector<WeightedWavelength> kEyeWavelengths = {
    {486.1327, 0.181}, {587.5618, 0.783}, {656.2725, 0.072}};

struct BestFocus {
    double film_z;  // mm, lens frame
    double rms;     // mm, of the spot there: root of the mean square distance to its centre
};

/// The film's place for the smallest RMS spot of a point on the axis at a distance (m,
/// infinity allowed): by exact rays, equal areas of the entrance pupil, clipped by the iris of
/// the f-stop and every clear aperture. Spots grow as a parabola in z, so that place is exact.
/// Error if no ray passes.
BestFocus best_focus(const Prescription& lens, double f_stop, double distance_m,
                     FocusFrom from = FocusFrom::pupil,
                     const std::vector<WeightedWavelength>& wavelengths = kEyeWavelengths);

}  // namespace dg
