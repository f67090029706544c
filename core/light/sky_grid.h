// sky_grid.h -- the luminance of a sky's picture, as cells between its texel centers.
//
// There are w columns by h + 1 rows of cells (the first and last row have half the height and touch the poles). In a
// cell, with x in [0,1] along azimuth and s in [0,1] linear in cos theta (so that equal areas of (x, s) are equal solid
// angles), the weight interpolates the weights of four texels bilinearly. Its integral over a cell is mean * solid angle.
// The small difference between s and the picture's v causes little noise. Directions are in the frame of the picture.
//
// Compensation for MIS: BSDF sampling finds the even part of the sky by itself, so a density for light sampling does
// better without it. Weights are then max(luminance - mean, kLeastWeight * luminance). The second term keeps the density
// positive wherever there is light, so that each strategy alone stays unbiased. Source: Karlik and others 2019, MIS
// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling (there without that term).
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "math/vec.h"

namespace dg {

/// A direction in texels: from the left edge of the picture, [0, w], and from the top, [0, h].
struct SkyTexels {
    float column, row;
};

/// A direction with its weight, cd/m2, which is proportional to the density there.
struct SkyDraw {
    Vec3f direction;
    float weight;
};

struct SkyGrid {
    static constexpr float kLeastWeight = 0.1f;

    int width = 0, height = 0;
    std::vector<double> cos_edge;  // h + 2: cos theta at the edges of the rows of cells

    SkyGrid() = default;
    /// `luminance`: of the texels, row by row.
    SkyGrid(int width, int height, std::vector<float> luminance);
    /// The grid with weights that are compensated by `mean`, the luminance over the sphere. Shares the luminance.
    SkyGrid compensated(float mean) const;

    int rows() const { return height + 1; }
    int wrap(int column) const {
        return column < 0 ? column + width : column >= width ? column - width : column;
    }
    int clamp_row(int row) const { return std::clamp(row, 0, height - 1); }
    float weight_of(float luminance) const { return std::max(luminance - subtracted_, kLeastWeight * luminance); }
    /// Inverse of weight_of().
    float luminance_of(float weight) const {
        return subtracted_ > 0 ? std::min(weight + subtracted_, weight / kLeastWeight) : weight;
    }
    /// Weights at the corners of a cell. Cell column c starts at the center of texel column c; cell row r starts at the
    /// center of texel row r - 1.
    std::array<float, 4> corners(int c, int r) const {
        const float* top = texels_->data() + std::size_t(clamp_row(r - 1)) * width;
        const float* low = texels_->data() + std::size_t(clamp_row(r)) * width;
        const int next = wrap(c + 1);
        return {weight_of(top[c]), weight_of(top[next]), weight_of(low[c]), weight_of(low[next])};
    }
    /// Size of each cell of a row, sr.
    double solid_angle(int r) const { return 2 * kPiD / width * (cos_edge[r] - cos_edge[r + 1]); }
    /// Integral of the weight over a cell.
    double weight(int c, int r) const {
        const auto k = corners(c, r);
        return solid_angle(r) * 0.25 * (double(k[0]) + k[1] + k[2] + k[3]);
    }
    /// Direction at a column, in cells.
    Vec3f direction(double column, double cos_theta) const;
    /// Center of a cell.
    Vec3f center(int c, int r) const { return direction(c + 0.5, 0.5 * (cos_edge[r] + cos_edge[r + 1])); }
    /// Draws a direction in a cell by weight, with u in [0,1)^2.
    SkyDraw sample_in(int c, int r, Vec2f u) const;
    /// Draws a direction in a block of cells uniformly; `c`, `r`: ranges of columns and rows.
    Vec3f sample_even(std::array<int, 2> c, std::array<int, 2> r, Vec2d u) const;

    SkyTexels texels(Vec3f direction) const;
    /// The cell of a direction.
    struct Place {
        int c, r;
        float x;   // in the cell
    };
    Place place(SkyTexels at) const;
    /// Weight at a direction in a cell.
    float weight(const Place& at, Vec3f direction) const;

  private:
    std::shared_ptr<const std::vector<float>> texels_;   // luminance
    float subtracted_ = 0;
};

}  // namespace dg
