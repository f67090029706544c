// lens_fit_simd.h -- a fitted lens on batches of rays: float, SIMD with run-time
// dispatch. The reference is lens_fit.h; tests hold them equal on every target. The
// signatures are those of trace_simd.h.
#pragma once
#include <vector>

#include "optics/polynomial/lens_fit.h"
#include "optics/trace_simd.h"

namespace dg {

/// Monomials [first, first + count) are those from `parent` on times a variable.
struct FitRun {
    int first = 0, parent = 0, count = 0, variable = 0;
};
/// Monomials one after the other, the first of which is 1.
struct FitProgram {
    int size = 1;
    std::vector<FitRun> runs;
};

/// Functions of lens_fit.h over the monomials of a program.
struct FitFunctionTables {
    int count = 0;
    std::vector<int> at;              // each term's place in the program
    std::vector<float> coefficients;  // [term][function]
};
struct FitBlockTables {
    FitFunctionTables x, y;
};
/// One function as a polynomial in l, whose coefficients are functions over monomials
/// without l; highest power first, as Horner's rule wants them.
struct FitLightTables {
    std::vector<FitFunctionTables> powers;
};

struct FitSegmentTables {
    float u_low = 0, u_high = 1;
    float u_scale = 2, u_offset = -1;  // U = u_scale u + u_offset
    int ray_runs = 0;                  // of the program: what the scene ray alone needs
    FitProgram program;
    FitBlockTables rays, points;
    FitLightTables light;
};

struct FitPupilTables {
    float film_x = 0, film_y = 0, slope_x = 1, slope_y = 1, shift_x = 0, shift_y = 0;
};

inline constexpr int kMostAngleTerms = 12;

/// What the kernels read of a fit.
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
    FitProgram inverse_program;
    FitBlockTables inverse;
};

FitTables make_fit_tables(const LensFit& fit, const IrisTables& iris);

/// Film -> scene, as trace_to_scene(). Rays outside of the fit's film or pupil are
/// stopped.
void fit_to_scene(const FitTables& fit, const FilmRays& in, SceneRays& out, int count);
/// Scene -> film, as trace_to_film(): the film ray that fit_to_scene() sends there, to
/// float precision.
void fit_to_film(const FitTables& fit, SceneRays& in, FilmRays& out, int count);

}  // namespace dg
