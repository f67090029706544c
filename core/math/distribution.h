// distribution.h -- sampling of tabulated weights: discrete, and piecewise constant in 1D and 2D.
//
// All use inverse CDFs, so stratified u give stratified samples; a guide table makes the search
// O(1) on average. Source: Chen and Asau 1974 (guide tables); Devroye 1986, II.2.4 and III.2.4.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

struct DiscreteSample {
    int index;
    float pmf;
    float u_remapped;  // uniform in [0,1), independent of index
};

struct ContinuousSample1D {
    float x;    // in [0,1)
    float pdf;  // density over [0,1)
    int index;
};

/// Samples index i with probability weights[i] / sum; never an index of weight 0. Throws Error for
/// an empty list, a weight that is negative, NaN or infinite, or if all are 0.
class DiscreteDistribution {
  public:
    DiscreteDistribution() = default;
    explicit DiscreteDistribution(std::span<const float> weights);
    explicit DiscreteDistribution(std::span<const double> weights);

    DiscreteSample sample(float u) const;
    float pmf(int i) const { return float(cdf_[i + 1] - cdf_[i]); }
    int size() const { return int(cdf_.size()) - 1; }
    bool empty() const { return cdf_.size() < 2; }
    double sum() const { return sum_; }  // of the weights

    /// Sampling of the weights as a density over [0,1): cell i covers [i, i+1) / size().
    ContinuousSample1D sample_continuous(float u) const;
    float pdf_continuous(float x) const;

  private:
    void build(std::span<const double> weights);

    std::vector<double> cdf_;           // size + 1, from exactly 0 to exactly 1
    std::vector<std::uint32_t> guide_;  // guide[j]: first cell that ends after j / guides
    double sum_ = 0;
};

struct Sample2D {
    float x, y;  // in [0,1)
    float pdf;   // density over the unit square
};

/// Density proportional to values[row * width + column]; x runs along rows, y across rows. Throws
/// Error like DiscreteDistribution, and if the number of values is not width * height.
class Distribution2D {
  public:
    Distribution2D() = default;
    Distribution2D(int width, int height, std::span<const float> values);

    Sample2D sample(Vec2f u) const;
    float pdf(float x, float y) const;  // 0 outside [0,1)^2
    bool empty() const { return width_ == 0; }
    /// Mean of the values.
    double integral() const { return rows_.sum() / (double(width_) * height_); }

  private:
    const float* row_cdf(int row) const {
        return cdf_.data() + std::size_t(row) * (width_ + 1);
    }
    int find_column(int row, float u) const;

    int width_ = 0, height_ = 0, guides_ = 0;
    DiscreteDistribution rows_;
    std::vector<float> cdf_;  // per row: width + 1
    std::vector<std::uint16_t>
        guide_;  // per row: guides_ entries, in units of guide steps of columns
};

}  // namespace dg
