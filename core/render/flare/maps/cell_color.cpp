#include "render/flare/maps/cell_color.h"

#include <algorithm>

#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kFine = GhostMap::kFineSpectrum;
constexpr float kStepNm = (kMaxWavelength - kMinWavelength) / (kFine - 1);

float node_nm(int k) { return spectrum_node(float(k) / GhostMap::kFine); }

/// Visibility of white light at the nodes of the fine spectrum, for sampling wavelengths.
const std::array<float, kFine>& seen() {
    static const auto made = [] {
        const ColorTable table{Responses()};
        std::array<float, kFine> sums{};
        for (int k = 0; k < kFine; ++k) {
            FilmColor c{};
            table.add(c, {1, 1, 1}, node_nm(k), 1);
            sums[k] = c[0] + c[1] + c[2];
        }
        return sums;
    }();
    return made;
}

/// Adds a spectrum's value at a node.
void add_node(ColorTable::Parts& to, const ColorTable::Parts& node, float value) {
    for (std::size_t part = 0; part < to.size(); ++part)
        for (std::size_t i = 0; i < to[part].size(); ++i) to[part][i] += value * node[part][i];
}

void add_light(FilmColor& to, const ColorTable::Parts& parts, Rgb light, float times) {
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i] += times * (parts[0][i] * light.x + parts[1][i] * light.y + parts[2][i] * light.z);
}

}  // namespace

CellColor::CellColor(const GhostMap& map, const GhostMap::Cell& cell, bool gray, const CellColors& colors)
    : colors_(colors) {
    draw_by(map.fine(cell));
    if (gray) sum_up(map.fine(cell), map.corners(cell));
}

/// Computes the quantiles of visible light that wavelengths are sampled by.
void CellColor::draw_by(const float* fine) {
    std::array<float, kFine> below{};   // cumulative light at nodes, linear between them
    for (int k = 1; k < kFine; ++k)
        below[k] = below[k - 1] + 0.5f * (seen()[k - 1] * fine[k - 1] + seen()[k] * fine[k]);
    int k = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const float want = below[kFine - 1] * float(i) / kSteps;
        while (k + 2 < kFine && below[k + 1] < want) ++k;
        const float own = below[k + 1] - below[k];
        const float part = own > 0 ? std::clamp((want - below[k]) / own, 0.f, 1.f) : 0;
        quantile_[i] = kMinWavelength + kStepNm * (float(k) + part);
    }
    quantile_[0] = kMinWavelength, quantile_[kSteps] = kMaxWavelength;   // covers the whole spectrum
}

void CellColor::sum_up(const float* fine, const float* corners) {
    int brightest = 0;
    for (int k = 1; k < kFine; ++k)
        if (seen()[k] * fine[k] > seen()[brightest] * fine[brightest]) brightest = k;
    gray_nm_ = node_nm(brightest);
    for (int k = 0; k < kFine; ++k) add_node(middle_, colors_.fine[k], fine[k]);
    for (int c = 0; c < kCorners; ++c)
        for (int k = 0; k < GhostMap::kSpectrum; ++k)
            add_node(corners_[c], colors_.coarse[k], corners[c * GhostMap::kSpectrum + k]);
}

float CellColor::nm(float u) const {
    const float at = u * kSteps;
    const int i = std::min(int(at), kSteps - 1);
    return quantile_[i] + (at - float(i)) * (quantile_[i + 1] - quantile_[i]);
}

FilmColor CellColor::of(const MapBatch& b, int i, Rgb light, float times) const {
    FilmColor color{};
    if (gray()) {
        times *= b.left[i];
        add_light(color, middle_, light, times * b.middle[i]);
        const auto weights = corner_weights({b.u[i], b.v[i]});
        for (int c = 0; c < kCorners; ++c) add_light(color, corners_[c], light, times * weights[c]);
        return color;
    }
    const auto after = std::ranges::upper_bound(quantile_, b.nm[i]);   // density of nm(u), constant in each step
    const int step = std::clamp(int(after - quantile_.begin()) - 1, 0, kSteps - 1);
    colors_.table.add(color, light, b.nm[i], times * b.pass[i] * (quantile_[step + 1] - quantile_[step]) * kSteps);
    return color;
}

}  // namespace dg
