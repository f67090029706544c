// lens_fit_simd.h -- fitted lens on batches of rays: float, SIMD with run-time dispatch, with the
// signatures of trace_simd.h. Tests compare it with the reference (lens_fit.h) on every instruction
// set.
#pragma once
#include <vector>

#include "optics/expansion/lens_fit.h"
#include "optics/trace/trace_simd.h"

namespace dg {

/// Flags on a node's count: all powers are even, or all are odd.
inline constexpr int kFitEven = 1 << 8, kFitOdd = 1 << 9;

/// Nested Horner scheme of one or two functions over common terms, with one level per variable,
/// highest powers first. A node stores the number of powers of its variable, followed by the child
/// nodes; the last variable's nodes have coefficients. Missing powers are stored as zeros, unless a
/// whole parity is missing (kFitEven, kFitOdd).
struct FitHorner {
    int count = 1;
    std::vector<int> nodes;
    std::vector<float> coefficients;  // interleaved by function
};
/// Vector as one scheme for A and B, or as two for x and y.
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

/// Tables of a fit for the kernels.
struct FitTables {
    bool axial = true;
    WavelengthScale scale = WavelengthScale::visible();
    float center_x = 0, center_y = 0, half_x = 1, half_y = 1;  // film, mm
    FitPupilTables pupil;
    float pupil_z = 0;  // mm, centre of the entrance pupil from the first vertex
    float front_curvature = 0;
    int angle_terms = kMostAngleTerms;  // of the series for sin and cos
    IrisTables iris;
    std::vector<float> outer2, inner2;  // mounts, mm^2
    std::vector<FitSegmentTables> segments;
    float inverse_direction = 1;  // 1 / rad
    FitPupilTables inverse_pupil;
    FitVectorTables inverse_film, inverse_pupil_point;
};

FitTables make_fit_tables(const LensFit& fit, const IrisTables& iris);

/// Film -> scene, like trace_to_scene(). Rays outside of the fit's film or pupil are clipped.
void fit_to_scene(const FitTables& fit, const FilmRays& in, SceneRays& out, int count);
/// Scene -> film, like trace_to_film(): inverts fit_to_scene() to float precision.
void fit_to_film(const FitTables& fit, SceneRays& in, FilmRays& out, int count);

}  // namespace dg
