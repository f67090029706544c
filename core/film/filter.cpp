// filter.cpp -- the shapes, and one table per axis.
#include "film/filter.h"

#include <array>
#include <cmath>

#include "math/error.h"

namespace dg {
namespace {

constexpr std::array<const char*, 5> kNames{"box", "gaussian", "blackman_harris",
                                            "mitchell", "tent"};

/// exp(-x^2 / 2 s^2) with s = radius / 3, lowered to end at 0.
double gaussian(double x) {
    return std::exp(-4.5 * x * x) - std::exp(-4.5);
}

/// Four-term window of least side lobes. Source: Harris 1978, On the Use of Windows for
/// Harmonic Analysis with the Discrete Fourier Transform, Proc. IEEE 66(1), minimum
/// 4-sample (-92 dB).
double blackman_harris(double x) {
    const double t = kPiD * (x + 1);
    return 0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
           0.01168 * std::cos(3 * t);
}

/// Cubic with B = C = 1/3, stretched from its own radius 2 to 1.
/// Source: Mitchell and Netravali 1988, Reconstruction Filters in Computer Graphics,
/// SIGGRAPH.
double mitchell(double x) {
    const double t = std::abs(2 * x), b = 1.0 / 3, c = 1.0 / 3;
    if (t >= 1)
        return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t +
                (-12 * b - 48 * c) * t + (8 * b + 24 * c)) /
               6;
    return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t +
            (6 - 2 * b)) /
           6;
}

/// The formula on [-1, 1], in units of the radius.
double shape(FilterKind kind, double x) {
    switch (kind) {
        case FilterKind::box:
            return 1;
        case FilterKind::gaussian:
            return gaussian(x);
        case FilterKind::blackman_harris:
            return blackman_harris(x);
        case FilterKind::mitchell:
            return mitchell(x);
        case FilterKind::tent:   // Bartlett's window
            return 1 - std::abs(x);
    }
    return 0;
}

/// Mean of the formula over step i, by Simpson's rule.
double step_mean(FilterKind kind, int i, int steps) {
    const double a = 2.0 * i / steps - 1, b = 2.0 * (i + 1) / steps - 1;
    return (shape(kind, a) + 4 * shape(kind, (a + b) / 2) + shape(kind, b)) / 6;
}

}  // namespace

FilterKind filter_kind(const std::string& name) {
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i]) return FilterKind(i);
    throw input_error("filter", "kind", "box, gaussian, blackman_harris, mitchell or tent",
                      name);
}

float default_radius(FilterKind kind) {
    if (kind == FilterKind::box) return 0.5f;
    if (kind == FilterKind::tent) return 1;   // pixels' tents add up to 1 everywhere
    return kind == FilterKind::mitchell ? 2.f : 1.5f;
}

Filter::Filter(FilterKind kind, float radius)
    : kind_(kind), radius_(radius), steps_per_px_(kSteps / (2 * radius)) {
    if (!(radius > 0 && radius <= 16))
        throw input_error("filter", "radius", "more than 0 and at most 16 px",
                          std::to_string(radius));
    std::vector<double> values(kSteps), magnitudes(kSteps);
    double sum = 0, absolute = 0;
    for (int i = 0; i < kSteps; ++i) {
        values[i] = step_mean(kind, i, kSteps);
        magnitudes[i] = std::abs(values[i]);
        sum += values[i];
        absolute += magnitudes[i];
    }
    const double step = 2.0 * radius / kSteps;
    integral_ = sum * step * sum * step;
    absolute_ = absolute / sum;
    for (const double v : values) table_.push_back(float(v / (sum * step)));
    magnitude_ = DiscreteDistribution(std::span<const double>(magnitudes));
}

double Filter::variance() const {
    const double step = 1 / double(steps_per_px_);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) * step - radius_;
        sum += table_[i] * (x * x + step * step / 12) * step;
    }
    return sum;
}

FilterSample Filter::sample(Vec2f u) const {
    if (kind_ == FilterKind::box)   // same as from the table
        return {{(2 * u.x - 1) * radius_, (2 * u.y - 1) * radius_}, 1};
    const DiscreteSample x = magnitude_.sample(u.x), y = magnitude_.sample(u.y);
    const float step = 2 * radius_ / kSteps;
    const bool negative = (table_[x.index] < 0) != (table_[y.index] < 0);
    return {{(float(x.index) + x.u_remapped) * step - radius_,
             (float(y.index) + y.u_remapped) * step - radius_},
            float(negative ? -absolute_integral() : absolute_integral())};
}

}  // namespace dg
