// fit_error.h -- errors of a fitted lens against the exact lens, on rays that were not used in the
// fit.
#pragma once
#include <vector>

namespace dg {

struct FitDeviation {
    double rms = 0, max = 0;
};

/// Errors for film radii in [low, high) mm.
struct FitErrorZone {
    double low = 0, high = 0;
    int rays = 0;
    FitDeviation direction;  // rad
    FitDeviation
        film;  // um: fitted scene ray, traced exactly back to the film, against the original film point
    FitDeviation iris, mount;    // mm
    FitDeviation transmittance;  // absolute, of a transmittance in [0, 1]
    double lost = 0;             // fraction of passing rays that the fit clips
    double leaked = 0;  // rays that the fit passes but the lens clips, relative to passing rays
};

struct FitError {
    FitErrorZone all;
    std::vector<FitErrorZone> zones;
};

}  // namespace dg
