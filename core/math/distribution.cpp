// distribution.cpp -- construction and search of the tables of distribution.h.
#include "math/distribution.h"

#include <cmath>
#include <limits>
#include <string>

#include "math/below_one.h"
#include "math/error.h"

namespace dg {
namespace {

constexpr int kColumnsPerGuide = 4;

/// Writes the cumulative sums divided by the total, so that the last is exactly 1; returns the
/// total.
template <typename Weight, typename Out>
double normalized_cdf(std::span<const Weight> weights, Out* cdf) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double w = weights[i];
        if (!(w >= 0 && w <= std::numeric_limits<double>::max()))
            throw input_error("distribution", "weight " + std::to_string(i),
                              "a finite number >= 0", std::to_string(w));
        sum += w;
    }
    cdf[0] = 0;
    double running = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        running += weights[i];
        cdf[i + 1] = sum > 0 ? Out(running / sum) : Out(0);
    }
    return sum;
}

/// guide[j] = first cell that ends after j / guides; guide[guides] = the last cell with a positive
/// weight.
template <typename Cdf, typename Out>
void fill_guide(const Cdf* cdf, int cells, int guides, Out* guide) {
    int last = cells - 1;
    while (last > 0 && cdf[last] >= 1) --last;
    int cell = 0;
    for (int j = 0; j < guides; ++j) {
        while (cell < last && !(double(cdf[cell + 1]) * guides > j)) ++cell;
        guide[j] = Out(cell);
    }
    guide[guides] = Out(last);
}

/// First cell in [first, last] that ends after u.
template <typename Cdf>
int bisect(const Cdf* cdf, int first, int last, double u) {
    while (first < last) {
        const int middle = (first + last) / 2;
        if (cdf[middle + 1] > u)
            last = middle;
        else
            first = middle + 1;
    }
    return first;
}

float below_one(double v) {
    return std::clamp(float(v), 0.f, kBelowOne);
}

/// (cell + offset) / cells as a float that maps back to the same cell: rounding could move it
/// across a border, into a cell with another density or zero density.
float place(int cell, double offset, int cells) {
    const float x = below_one((cell + offset) / cells);
    const int found = int(double(x) * cells);
    if (found == cell) return x;
    return std::nextafter(x, found < cell ? 1.f : 0.f);
}

}  // namespace

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
    build(weights);
}

DiscreteDistribution::DiscreteDistribution(std::span<const float> weights) {
    const std::vector<double> copy(weights.begin(), weights.end());
    build(copy);
}

void DiscreteDistribution::build(std::span<const double> weights) {
    cdf_.resize(weights.size() + 1);
    sum_ = normalized_cdf(weights, cdf_.data());
    if (!(sum_ > 0 && sum_ <= std::numeric_limits<double>::max()))
        throw input_error("distribution",
                          "sum of " + std::to_string(weights.size()) + " weights",
                          "a finite number > 0", std::to_string(sum_));
    guide_.resize(weights.size() + 1);
    fill_guide(cdf_.data(), size(), size(), guide_.data());
}

DiscreteSample DiscreteDistribution::sample(float u) const {
    u = below_one(u);
    const std::size_t j = std::size_t(double(u) * size());
    const int i = bisect(cdf_.data(), int(guide_[j]), int(guide_[j + 1]), u);
    const double mass = cdf_[i + 1] - cdf_[i];
    return {i, float(mass), below_one((u - cdf_[i]) / mass)};
}

ContinuousSample1D DiscreteDistribution::sample_continuous(float u) const {
    const DiscreteSample s = sample(u);
    const float x = place(s.index, s.u_remapped, size());
    return {x, float(double(s.pmf) * size()), s.index};
}

float DiscreteDistribution::pdf_continuous(float x) const {
    if (!(x >= 0 && x < 1)) return 0;
    return float(double(pmf(int(double(x) * size()))) * size());
}

Distribution2D::Distribution2D(int width, int height, std::span<const float> values)
    : width_(width), height_(height) {
    if (width < 1 || height < 1 || width > 65535 ||
        values.size() != std::size_t(width) * std::size_t(height))
        throw input_error("distribution", "number of values",
                          std::to_string(width) + " x " + std::to_string(height) +
                              " (at most 65535 columns)",
                          std::to_string(values.size()));
    guides_ = std::max(1, width / kColumnsPerGuide);
    cdf_.resize(std::size_t(height) * (width + 1));
    guide_.resize(std::size_t(height) * (guides_ + 1));
    std::vector<double> sums(height);
    for (int row = 0; row < height; ++row) {
        float* cdf = cdf_.data() + std::size_t(row) * (width + 1);
        sums[row] = normalized_cdf(values.subspan(std::size_t(row) * width, width), cdf);
        fill_guide(cdf, width, guides_, guide_.data() + std::size_t(row) * (guides_ + 1));
    }
    rows_ = DiscreteDistribution(std::span<const double>(sums));
}

int Distribution2D::find_column(int row, float u) const {
    const std::uint16_t* guide = guide_.data() + std::size_t(row) * (guides_ + 1);
    const int j = int(double(u) * guides_);
    return bisect(row_cdf(row), guide[j], guide[j + 1], u);
}

Sample2D Distribution2D::sample(Vec2f u) const {
    const DiscreteSample row = rows_.sample(u.y);
    const float ux = below_one(u.x);
    const int column = find_column(row.index, ux);
    const float* cdf = row_cdf(row.index) + column;
    const double mass = double(cdf[1]) - cdf[0];
    return {place(column, (ux - cdf[0]) / mass, width_),
            place(row.index, row.u_remapped, height_),
            float(mass * width_ * row.pmf * height_)};
}

float Distribution2D::pdf(float x, float y) const {
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return 0;
    const int column = int(double(x) * width_), row = int(double(y) * height_);
    const float* cdf = row_cdf(row) + column;
    const double mass = double(cdf[1]) - cdf[0];
    return float(mass * width_ * rows_.pmf(row) * height_);
}

}  // namespace dg
