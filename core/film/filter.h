// filter.h -- reconstruction filters, applied by importance sampling: a sample touches
// one pixel.
#pragma once
#include <string>
#include <vector>

#include "math/distribution.h"
#include "math/vec.h"

namespace dg {

enum class FilterKind { box, gaussian, blackman_harris, mitchell, tent };

/// "box", "gaussian", "blackman_harris", "mitchell" or "tent"; anything else throws Error.
FilterKind filter_kind(const std::string& name);
/// Default radius, px: 0.5, 1.5, 1.5, 2, 1.
float default_radius(FilterKind kind);

struct FilterSample {
    Vec2f offset;  // px, from the pixel's centre, within the radius
    float weight;  // +-(integral of |f|) / (integral of f); 1 for a filter without negative lobes
};

/// Separable filter on a square of +-radius px. The filter is piecewise constant: 256 steps per axis, each with the mean
/// of the formula over the step. sample(), evaluate() and the weight use this table, so they agree exactly.
class Filter {
  public:
    explicit Filter(FilterKind kind = FilterKind::blackman_harris)
        : Filter(kind, default_radius(kind)) {}
    /// Throws Error unless 0 < radius <= 16 px.
    Filter(FilterKind kind, float radius);

    FilterSample sample(Vec2f u) const;
    /// Value of the filter, normalized to unit integral; 0 outside.
    float evaluate(Vec2f offset) const { return axis(offset.x) * axis(offset.y); }
    /// Factor of the filter along one axis.
    float axis(float x) const {
        const float t = (x + radius_) * steps_per_px_;
        if (!(t >= 0 && t < float(kSteps))) return 0;
        return table_[int(t)];
    }

    /// Factors at x, x - 1, x - 2, ...
    void axis(float x, int count, float* values) const {
        float t = (x + radius_) * steps_per_px_;
        for (int i = 0; i < count; ++i, t -= steps_per_px_)
            values[i] = t >= 0 && t < float(kSteps) ? table_[int(t)] : 0;
    }

    FilterKind kind() const { return kind_; }
    float radius() const { return radius_; }
    /// Integral of the formula before normalization, px^2.
    double integral() const { return integral_; }
    /// Second moment along one axis, px^2.
    double variance() const;
    /// Integral of |evaluate|: 1, or more if there are negative lobes.
    double absolute_integral() const { return absolute_ * absolute_; }

  private:
    static constexpr int kSteps = 256;

    FilterKind kind_;
    float radius_, steps_per_px_;
    double integral_ = 0, absolute_ = 1;
    std::vector<float> table_;        // unit integral along one axis
    DiscreteDistribution magnitude_;  // |table|
};

}  // namespace dg
