// lens_fit_simd.h -- a fitted lens on batches of rays: float, SIMD with run-time
// dispatch. The reference is lens_fit.h; tests hold them equal on every target. The
// signatures are those of trace_simd.h.
#pragma once
#include <vector>

#include "optics/expansion/lens_fit.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Added to a node's number: its powers are all even, or all odd.
inline constexpr int kFitEven = 1 << 8, kFitOdd = 1 << 9;

/// One or two functions over the same terms as a nested Horner scheme, variable within
/// variable, the highest powers first: for each node the number of powers of its
/// variable, then those powers' nodes, coefficients where the last variable is. Powers
/// that are missed have coefficients of 0, unless all those of the other parity are
/// (kFitEven, kFitOdd).
struct FitHorner {
    int count = 1;
    std::vector<int> nodes;
    std::vector<float> coefficients;  // the functions' by turns
};
/// A vector: A and B in one scheme, or x and y in one each.
struct FitVectorTables {
    FitHorner x, y;
};

struct FitSegmentTables {
    float u_low = 0, u_high = 1;
    float u_scale = 2, u_offset = -1;  // U = u_scale u + u_offset
    bool bends = false;
    FitVectorTables bend, direction, offset, iris;
    std::vector<FitVectorTables> mounts;
    FitHorner light;
};

struct FitPupilTables {
    float film_x = 0, film_y = 0, slope_x = 1, slope_y = 1, shift_x = 0, shift_y = 0;
};

inline constexpr int kMostAngleTerms = 12;

/// Tables of a fit that the kernels read.
struct FitTables {
    bool axial = true;
    WavelengthScale scale = WavelengthScale::visible();
    float center_x = 0, center_y = 0, half_x = 1, half_y = 1;  // film, mm
    FitPupilTables pupil;
    float pupil_z = 0;  // middle of the entrance pupil from the first vertex, mm
    float front_curvature = 0;
    int angle_terms = kMostAngleTerms;  // of the series of sin and cos
    IrisTables iris;
    std::vector<float> outer2, inner2;  // mounts, mm^2
    std::vector<FitSegmentTables> segments;
    float inverse_direction = 1;  // 1 / rad
    FitPupilTables inverse_pupil;
    FitVectorTables inverse_film, inverse_pupil_point;
};

FitTables make_fit_tables(const LensFit& fit, const IrisTables& iris);

/// Film -> scene, as trace_to_scene(). Rays outside of the fit's film or pupil are
/// stopped.
void fit_to_scene(const FitTables& fit, const FilmRays& in, SceneRays& out, int count);
/// Scene -> film, as trace_to_film(): the film ray that fit_to_scene() sends there, to
/// float precision.
void fit_to_film(const FitTables& fit, SceneRays& in, FilmRays& out, int count);

}  // namespace dg
