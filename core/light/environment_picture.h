// environment_picture.h -- an environment's picture as cells between its texel centers; see environment.cpp.
#pragma once
#include <array>

#include "light/environment.h"

namespace dg {

struct Environment::Picture {
    int width, height;
    std::vector<Rgb> pixels;      // cd/m2
    std::vector<float> lum;       // luminance of the texels
    std::vector<float> cos_edge;  // h + 2: cos theta at the edges of the rows of cells
    Distribution2D cells;         // w x (h + 1), weight: mean luminance * solid angle
    double total = 0;             // sum of the weights
    Affine3f world_from_environment, environment_from_world;

    int wrap(int column) const {
        return column < 0 ? column + width : column >= width ? column - width : column;
    }
    int clamp_row(int row) const { return std::clamp(row, 0, height - 1); }
    /// Cell column c starts at the center of texel column c; cell row r starts at the center of texel row r - 1.
    std::array<float, 4> corners(int c, int r) const {
        const std::size_t top = std::size_t(clamp_row(r - 1)) * width,
                          low = std::size_t(clamp_row(r)) * width;
        return {lum[top + c], lum[top + wrap(c + 1)], lum[low + c],
                lum[low + wrap(c + 1)]};
    }
    void build_cells();
    /// Integral of the luminance over a cell.
    double weight(int c, int r) const {
        const double solid_angle = 2 * kPiD / width * (double(cos_edge[r]) - cos_edge[r + 1]);
        const auto k = corners(c, r);
        return solid_angle * 0.25 * (double(k[0]) + k[1] + k[2] + k[3]);
    }
    /// Direction (frame of the picture) at (x, s) of a cell.
    Vec3f direction(int c, int r, float x, float s) const;
    /// Samples a direction by luminance, with u in [0,1)^2.
    Vec3f sample_in(int c, int r, Vec2f u) const;
    /// The cell of a direction (frame of the picture), and the luminance of the density there.
    struct Place {
        int c, r;
        float luminance;
    };
    Place place(Vec3f direction) const;
};

}  // namespace dg
