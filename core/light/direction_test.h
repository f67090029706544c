// direction_test.h -- for tests: compares samples of directions with their density.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "math/hash.h"
#include "math/statistics.h"
#include "math/vec.h"

namespace dg {

/// Cells of equal size in (cos theta, phi) around an axis.
struct DirectionGrid {
    Frame frame = Frame::from_normal({0, 0, 1});
    double cos_min = -1, cos_max = 1;  // tested part of the sphere
    int rows = 16, columns = 32;
    int cells() const { return rows * columns; }

    int cell(Vec3f w) const {
        const Vec3f l = frame.to_local(w);
        const double row = (cos_max - l.z) / (cos_max - cos_min) * rows;
        const double column = (atan2(l.y, l.x) / (2 * kPiD) + 0.5) * columns;
        if (row < -1e-3 || row > rows + 1e-3) return -1;
        return std::clamp(int(row), 0, rows - 1) * columns +
               std::clamp(int(column), 0, columns - 1);
    }
    Vec3f direction(double row, double column) const {
        const double z = cos_max - row / rows * (cos_max - cos_min);
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        const double phi = 2 * kPiD * (column / columns - 0.5);
        return frame.to_world(
            {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
    }
    double cell_solid_angle() const { return 2 * kPiD * (cos_max - cos_min) / cells(); }
};

/// p-value of a chi-square test of `samples` draws against `pdf`. The density is integrated over each cell by the
/// midpoint rule with `sub` x `sub` points. Draws without a result form a cell with the probability 1 - integral of the
/// pdf.
inline double direction_p_value(const DirectionGrid& grid,
                                const std::function<std::optional<Vec3f>(Vec2f)>& sample,
                                const std::function<double(Vec3f)>& pdf,
                                int samples = 200000, int sub = 16) {
    std::vector<double> observed(grid.cells() + 1, 0), expected(grid.cells() + 1, 0);
    for (int i = 0; i < samples; ++i) {
        const auto w =
            sample({float(hash_uniform(11, 2 * i)), float(hash_uniform(11, 2 * i + 1))});
        const int cell = w ? grid.cell(*w) : grid.cells();
        if (cell < 0) return 0;
        observed[cell] += 1;
    }
    double sum = 0;
    for (int c = 0; c < grid.cells(); ++c) {
        double mean = 0;
        for (int i = 0; i < sub * sub; ++i) {
            mean += pdf(grid.direction(c / grid.columns + (i / sub + 0.5) / sub,
                                       c % grid.columns + (i % sub + 0.5) / sub));
        }
        expected[c] = mean / (sub * sub) * grid.cell_solid_angle() * samples;
        sum += expected[c];
    }
    expected.back() = std::max(0.0, samples - sum);
    return chi_square_test(observed, expected).p_value;
}

}  // namespace dg
