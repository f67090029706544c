// aim_tables.h -- flat float tables of an aim (pupil.h) that the SIMD kernels read.
#pragma once
#include <vector>

namespace dg {

inline constexpr int kRadialSegments = 64;

/// Columns that cover what is visible of the iris (pupil_region.h); what they cover in vain falls as one
/// over their number.
inline constexpr int kColumns = 64;

/// Region drawn at a film point: points of the iris shape, of the visible part of the iris, or slopes.
enum class AimRegion : int { shape, visible, slopes };

/// Cells a side into which the film of a lens without symmetry is divided.
inline constexpr int kFilmCells = 12;

/// The aim of a lens without axial symmetry: a polynomial in all coordinates (free_basis.h), and
/// where to draw a, cell by cell of the film.
struct FreeAimTables {
    int degree = 0;                   // 0: the lens is symmetric, and this is not used
    std::vector<float> coefficients;  // of m.x and m.y in turn, in the order of for_each_free_term()
    float center_x = 0, center_y = 0, half_x = 1, half_y = 1;  // mm: the film, f in [-1, 1]
    float normal[3] = {0, 0, 1};      // of the film, lens frame
    std::vector<float> region, area;  // per cell, as in AimTables
    // Columns in the frame of the iris, a^ or slopes: edges, lower and upper ends, kColumns + 1 per cell.
    std::vector<float> column_x, column_low, column_high;
};

/// The film slope m(f, a, l) of pupil.h: polynomials in U = 2u-1, s, W = 2w-1, l, and
/// where to draw a.
struct AimTables {
    int degree = 3;                   // k
    std::vector<float> coefficients;  // A and B in turn, in the order of for_each_term()
    float film_radius = 1,
          iris_scale = 1;  // mm: f = film_radius * f^, a = iris_scale * a^
    float enlargement = 1.01f;
    float shape_area = 0;  // of the enlarged iris / iris_scale^2
    bool all_shape = true;
    float region[kRadialSegments];  // AimRegion as a number
    float area[kRadialSegments];    // of what is drawn there; 0: nothing
    // Columns in the meridional frame, a^ or slopes: edges, and half heights (the last is not used).
    float column_x[kRadialSegments * (kColumns + 1)];
    float column_half[kRadialSegments * (kColumns + 1)];
    FreeAimTables free;
};

}  // namespace dg
