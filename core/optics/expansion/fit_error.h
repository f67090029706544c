// fit_error.h -- how far a fitted lens is from the exact one, on rays that it was not
// fitted to.
#pragma once
#include <vector>

namespace dg {

struct FitDeviation {
    double rms = 0, max = 0;
};

/// Over the film radii [low, high) mm.
struct FitErrorZone {
    double low = 0, high = 0;
    int rays = 0;
    FitDeviation direction;  // rad
    FitDeviation
        film;  // um: the fitted scene ray traced exactly back, against where it came from
    FitDeviation iris, mount;    // mm
    FitDeviation transmittance;  // of 1
    double lost = 0;             // share of the rays that pass which the fit stops
    double leaked = 0;  // rays that the fit lets pass though they are stopped, against
                        // those that pass
};

struct FitError {
    FitErrorZone all;
    std::vector<FitErrorZone> zones;
};

}  // namespace dg
