#include "render/flare/flare_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dg {
namespace {

constexpr int kBins = 32;          // wavelength bins
constexpr int kEnough = 6;         // hits per bin
constexpr double kEvenBins = 0.1, kEvenCells = 0.05;   // uniform share of bins and of cells

constexpr double kSpread[] = {1, 0.1, 0.02};   // blur over neighbouring cells, by distance

int place(float x, int count) {
    return std::clamp(int(x * float(count)), 0, count - 1);
}

/// Adds a constant to all values, such that it makes up a given share of the new sum.
template <typename T>
void add_even(std::vector<T>& values, double share) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
    for (T& v : values) v += T(share / (1 - share) * mean);
}

}  // namespace

FlareWeights::FlareWeights(const FlareFound& found, const FlareTiles& tiles, int cells_across,
                           int spread)
    : across(cells_across), cells(std::size_t(across) * across) {
    weigh_wavelengths(found, tiles);
    std::vector<double> squares(cells.size());
    for (const FlareFound::Hit& hit : found.hits)
        squares[cell_of(found.probe.where, hit.at, across)] += hit.share * square(hit, tiles);
    for (int r = 0; r < across; ++r)
        for (int c = 0; c < across; ++c) {
            const double weight = std::sqrt(blurred(squares, r, c, spread) / double(cells.size()));
            cells[std::size_t(r) * across + c] = float(weight), sum += weight;
        }
    add_even(cells, kEvenCells);
}

/// Wavelengths differ: coatings reflect ten times more violet and deep red than light in between.
void FlareWeights::weigh_wavelengths(const FlareFound& found, const FlareTiles& tiles) {
    const int bins = std::clamp(int(found.hits.size()) / kEnough, 1, kBins);
    wavelengths.assign(bins, 1);
    if (bins == 1) return;
    std::vector<double> weights(bins);
    for (const FlareFound::Hit& hit : found.hits)
        weights[place(hit.lambda, bins)] += hit.share * square(hit, tiles);
    for (double& w : weights) w = std::sqrt(w);
    const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / bins;
    if (!(mean > 0)) return;
    for (double& w : weights) w /= mean;
    add_even(weights, kEvenBins);
    for (int i = 0; i < bins; ++i) wavelengths[i] = weights[i] * (1 - kEvenBins);
}

/// Second moment of a hit's light, with wavelengths drawn by their weights.
double FlareWeights::square(const FlareFound::Hit& hit, const FlareTiles& tiles) const {
    const double light = hit.rgb * tiles.importance(hit.px);
    return light * light / wavelengths[place(hit.lambda, int(wavelengths.size()))];
}

/// Blurs squares over neighbouring cells: a cell without hits may receive light near a lit neighbour.
double FlareWeights::blurred(const std::vector<double>& squares, int row, int column, int spread) const {
    double sum_of = 0, weights = 0;
    for (int y = std::max(0, row - spread); y <= std::min(across - 1, row + spread); ++y)
        for (int x = std::max(0, column - spread); x <= std::min(across - 1, column + spread); ++x) {
            const double weight = kSpread[std::max(std::abs(y - row), std::abs(x - column))];
            sum_of += weight * squares[std::size_t(y) * across + x], weights += weight;
        }
    return sum_of / weights;
}

}  // namespace dg
