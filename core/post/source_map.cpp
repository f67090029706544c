#include "post/source_map.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kCell = SourceMap::kCell;

/// Lagrange cubic through values at -1, 0, 1, 2: coefficients of 1, t, t^2, t^3.
std::array<float, 4> cubic(float a, float b, float c, float d) {
    a -= b, c -= b, d -= b;  // equal values are reproduced exactly
    return {b, c - a / 3 - d / 6, (a + c) / 2, (d - a) / 6 - c / 2};
}

float value(const std::array<float, 4>& k, float t) {
    return k[0] + t * (k[1] + t * (k[2] + t * k[3]));
}

/// Interpolates a coordinate in a cell between nodes: first along columns, then along each row.
void between(const SourceMap& map, int column, int row, int axis, float* out,
             int stride) {
    const std::size_t line = 2 * std::size_t(map.columns + 3);
    const float* first = map.nodes.data() + row * line + 2 * std::size_t(column) + axis;
    std::array<std::array<float, 4>, 4> down;
    for (int i = 0; i < 4; ++i) {
        const float* n = first + 2 * i;
        down[i] = cubic(n[0], n[line], n[2 * line], n[3 * line]);
    }
    for (int v = 0; v < kCell; ++v) {
        const float t = float(v) / kCell;
        const auto along = cubic(value(down[0], t), value(down[1], t), value(down[2], t),
                                 value(down[3], t));
        for (int u = 0; u < kCell; ++u)
            out[v * stride + u] = value(along, float(u) / kCell);
    }
}

/// Both coordinates at a point given in cells; NaN where the nodes do not apply.
void at_point(const SourceMap& map, double x, double y, float* out) {
    out[0] = out[1] = NAN;
    if (!(x >= 0 && y >= 0 && x < map.columns && y < map.rows)) return;
    const int column = int(x), row = int(y);
    if (map.exact[std::size_t(row) * map.columns + column] >= 0) return;
    const std::size_t line = 2 * std::size_t(map.columns + 3);
    for (int axis = 0; axis < 2; ++axis) {
        const float* n = map.nodes.data() + row * line + 2 * std::size_t(column) + axis;
        float across[4];
        for (int j = 0; j < 4; ++j, n += line)
            across[j] = value(cubic(n[0], n[2], n[4], n[6]), float(x - column));
        out[axis] = value(cubic(across[0], across[1], across[2], across[3]),
                          float(y - row));
    }
}

}  // namespace

void SourceMap::check() const {
    const auto want = [](const char* what, std::size_t wanted, std::size_t got) {
        if (wanted != got)
            throw input_error("map", what, std::to_string(wanted) + " values",
                              std::to_string(got));
    };
    if (columns < 1 || rows < 1 || top < 0 || top % kCell != 0)
        throw input_error("map", "cells", "at least one, from a row that is a multiple of 16",
                          std::to_string(top));
    want("nodes", std::size_t(rows + 3) * (columns + 3) * 2, nodes.size());
    want("exact", std::size_t(rows) * columns, exact.size());
    const std::size_t cell = 2 * kCell * kCell;
    if (exact_cells.size() % cell != 0) want("exact_cells", cell, exact_cells.size());
    for (std::int32_t k : exact)
        if (k < -1 || k >= std::int64_t(exact_cells.size() / cell))
            throw input_error("map", "exact", "-1 or a cell", std::to_string(k));
}

std::vector<float> SourceMap::displacements(int width, int begin, int end) const {
    std::vector<float> out(std::size_t(end - begin) * width * 2);
    CellMap cell;
    for (int row = (begin - top) / kCell; row < (end - top + kCell - 1) / kCell; ++row)
        for (int column = 0; column * kCell < width; ++column) {
            cell.read(*this, column, row);
            const int y0 = top + row * kCell, x0 = column * kCell;
            for (int y = std::max(y0, begin); y < std::min(y0 + kCell, end); ++y)
                for (int x = x0; x < std::min(x0 + kCell, width); ++x) {
                    float* to = out.data() + 2 * (std::size_t(y - begin) * width + x);
                    to[0] = cell.dx[y - y0][x - x0], to[1] = cell.dy[y - y0][x - x0];
                }
        }
    return out;
}

std::vector<float> SourceMap::displacements_at(std::span<const double> points) const {
    std::vector<float> out(points.size());
    constexpr std::size_t kPart = 4096;
    const std::size_t parts = (points.size() / 2 + kPart - 1) / kPart;
    oneapi::tbb::parallel_for(std::size_t(0), parts, [&](std::size_t part) {
        const std::size_t end = std::min(2 * kPart * (part + 1), points.size());
        for (std::size_t k = 2 * kPart * part; k < end; k += 2)
            at_point(*this, points[k] / kCell, (points[k + 1] - top) / kCell, &out[k]);
    });
    return out;
}

void SourceMap::read_cell(int column, int row, float* dx, float* dy, int stride) const {
    const std::int32_t k = exact[std::size_t(row) * columns + column];
    if (k < 0) {
        between(*this, column, row, 0, dx, stride);
        between(*this, column, row, 1, dy, stride);
        return;
    }
    const float* p = exact_cells.data() + std::size_t(k) * kCell * kCell * 2;
    for (int v = 0; v < kCell; ++v)
        for (int u = 0; u < kCell; ++u, p += 2)
            dx[v * stride + u] = p[0], dy[v * stride + u] = p[1];
}

}  // namespace dg
