// aim_tables.h -- tables of an aim (pupil.h) in float, for the SIMD kernels.
#pragma once
#include <vector>

namespace dg {

inline constexpr int kRadialSegments = 64;

/// Columns that cover the visible part of the iris (pupil_region.h). The wasted area decreases as
/// one over their number.
inline constexpr int kColumns = 64;

/// Sampling domain at a film point: the iris shape, the visible part of the iris, or a box of
/// slopes.
enum class AimRegion : int { shape, visible, slopes };

/// Cells per side of the film's grid, for lenses without symmetry.
inline constexpr int kFilmCells = 12;

/// Aim of a lens without axial symmetry: a polynomial in all coordinates (free_basis.h), and the
/// sampling domain of a in each cell of the film.
struct FreeAimTables {
    int degree = 0;                   // 0: unused, the lens is symmetric
    std::vector<float> coefficients;  // m.x and m.y interleaved, in the order of for_each_free_term()
    float center_x = 0, center_y = 0, half_x = 1, half_y = 1;  // mm: film rectangle, mapped to f in [-1, 1]
    float normal[3] = {0, 0, 1};      // of the film, in the lens frame
    std::vector<float> region, area;  // per cell, as in AimTables
    // Columns in the frame of the iris (a^) or in slopes: edges, lower and upper ends; kColumns + 1
    // per cell.
    std::vector<float> column_x, column_low, column_high;
};

/// Aim of a symmetric lens: the film slope m(f, a, l) of pupil.h as polynomials in U = 2u-1, s, W =
/// 2w-1 and l, and the sampling domain of a for each segment of the film radius.
struct AimTables {
    int degree = 3;                   // degree k of the basis
    std::vector<float> coefficients;  // A and B interleaved, in the order of for_each_term()
    float film_radius = 1,
          iris_scale = 1;  // mm: f = film_radius * f^, a = iris_scale * a^
    float enlargement = 1.01f;
    float shape_area = 0;  // area of the enlarged iris / iris_scale^2
    bool all_shape = true;
    float region[kRadialSegments];  // AimRegion as a number
    float area[kRadialSegments];    // area of the sampling domain; 0: no rays
    // Columns in the meridional frame (a^) or in slopes: edges and half heights (the last half
    // height is unused).
    float column_x[kRadialSegments * (kColumns + 1)];
    float column_half[kRadialSegments * (kColumns + 1)];
    FreeAimTables free;
};

}  // namespace dg
