// bsdf_check.h -- measures the properties that every BSDF must have, for tests. Wrappers with planted faults go through
// the same functions.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "material/bsdf.h"
#include "math/statistics.h"

namespace dg::check {

struct Random {
    std::uint64_t state;
    float next() {  // SplitMix64
        std::uint64_t z = state += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return static_cast<float>((z ^ (z >> 31)) >> 40) * 0x1p-24f;
    }
    Vec2f next_2d() {
        const float x = next();
        return {x, next()};
    }
    Vec3f direction() {
        const float z = 1 - 2 * next(), phi = 2 * kPi * next();
        const float r = std::sqrt(std::max(0.f, 1 - z * z));
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
};

/// Direction of a midpoint grid over the sphere around `frame`.
inline Vec3f grid_direction(const Frame& frame, double theta, double phi) {
    const double r = std::sin(theta);
    return frame.to_world(
        to_float(Vec3d{r * std::cos(phi), r * std::sin(phi), std::cos(theta)}));
}

/// A configuration of a check: the surface's frame, wo, and the relative index of refraction.
struct Setting {
    Frame frame;  // z is ng
    Vec3f wo;
    float eta = 1;  // index beyond / index on the side of wo; refracted radiance is scaled by
                    // 1 / eta^2
    float eta_squared(Vec3f wi) const {
        return dot(frame.z, wi) * dot(frame.z, wo) < 0 ? eta * eta : 1;
    }
};

struct Albedo {
    double value[kWavelengths] = {}, error[kWavelengths] = {};  // mean, standard error
};

/// Albedo as the mean of sample weights, without the 1 / eta^2 of refraction.
template <typename B>
Albedo albedo_by_sampling(const B& bsdf, const Setting& s, int count,
                          std::uint64_t seed) {
    Random random{seed};
    double sum[kWavelengths] = {}, squares[kWavelengths] = {};
    for (int i = 0; i < count; ++i) {
        const float u_lobe = random.next();
        const auto sample = bsdf.sample(s.wo, u_lobe, random.next_2d());
        if (!sample) continue;
        for (int k = 0; k < kWavelengths; ++k) {
            const double v = sample->weight[k] * s.eta_squared(sample->wi);
            sum[k] += v;
            squares[k] += v * v;
        }
    }
    Albedo a;
    for (int k = 0; k < kWavelengths; ++k) {
        a.value[k] = sum[k] / count;
        const double variance = squares[k] / count - a.value[k] * a.value[k];
        a.error[k] = std::sqrt(std::max(0.0, variance) / count);
    }
    return a;
}

/// Coefficient and probability of each delta lobe that u_lobe can select. Two lobes in the same direction, such as a
/// smooth coat's and its base's, differ in probability.
struct Deltas {
    double value[kWavelengths] = {};
    double probability = 0;
};
template <typename B>
Deltas delta_lobes(const B& bsdf, const Setting& s) {
    Deltas sum;
    std::vector<BsdfSample> seen;
    const auto same = [](const BsdfSample& a, const BsdfSample& b) {
        return a.transmitted == b.transmitted && length_squared(a.wi - b.wi) < 1e-8f &&
               std::abs(a.pdf - b.pdf) < 1e-5f;
    };
    for (int i = 0; i < 1000; ++i) {
        const auto d = bsdf.sample(s.wo, (i + 0.5f) / 1000, {0.3f, 0.7f});
        if (!d || !d->specular) continue;
        if (std::any_of(seen.begin(), seen.end(),
                        [&](const BsdfSample& o) { return same(*d, o); }))
            continue;
        seen.push_back(*d);
        sum.probability += d->pdf;
        for (int k = 0; k < kWavelengths; ++k)
            sum.value[k] +=
                static_cast<double>(d->weight[k]) * d->pdf * s.eta_squared(d->wi);
    }
    return sum;
}

/// Albedo as the integral of evaluate() over the sphere by the midpoint rule, plus the delta lobes.
template <typename B>
Albedo albedo_by_quadrature(const B& bsdf, const Setting& s, int rows = 200) {
    Albedo a;
    const int columns = 2 * rows;
    for (int i = 0; i < rows; ++i) {
        const double theta = kPiD * (i + 0.5) / rows;
        const double cell = kPiD / rows * 2 * kPiD / columns * std::sin(theta);
        for (int j = 0; j < columns; ++j) {
            const Vec3f wi =
                grid_direction(s.frame, theta, 2 * kPiD * (j + 0.5) / columns);
            const Spectrum f = bsdf.evaluate_with_pdf(s.wo, wi).f_cos;
            for (int k = 0; k < kWavelengths; ++k)
                a.value[k] += f[k] * s.eta_squared(wi) * cell;
        }
    }
    const Deltas d = delta_lobes(bsdf, s);
    for (int k = 0; k < kWavelengths; ++k) a.value[k] += d.value[k];
    return a;
}

/// Largest difference between the two albedos in standard errors, beyond a quadrature error of 3e-3.
template <typename B>
double furnace_deviation(const B& bsdf, const Setting& s, const Albedo& quadrature,
                         std::uint64_t seed) {
    const Albedo mc = albedo_by_sampling(bsdf, s, 40000, seed);
    double worst = 0;
    for (int k = 0; k < kWavelengths; ++k) {
        const double q = quadrature.value[k];
        worst = std::max(worst,
                         (std::abs(mc.value[k] - q) - 3e-3 * q) / (mc.error[k] + 1e-6));
    }
    return worst;
}

/// Chi-square test of sample() against pdf(). Failed samples form a cell, too, so that the test detects a density with
/// the correct shape and a wrong integral.
template <typename B>
double chi_square_p(const B& bsdf, const Setting& s, std::uint64_t seed) {
    constexpr int kRows = 16, kColumns = 32, kInner = 12, kCount = 50000;
    std::vector<double> expected(kRows * kColumns + 1, 0.0),
        observed(kRows * kColumns + 1, 0.0);
    const double delta = delta_lobes(bsdf, s).probability;
    double total = delta;
    for (int i = 0; i < kRows * kInner; ++i) {
        const double theta = kPiD * (i + 0.5) / (kRows * kInner);
        const double cell = kPiD / (kRows * kInner) * 2 * kPiD / (kColumns * kInner);
        for (int j = 0; j < kColumns * kInner; ++j) {
            const Vec3f wi = grid_direction(s.frame, theta,
                                            2 * kPiD * (j + 0.5) / (kColumns * kInner));
            const double p =
                bsdf.evaluate_with_pdf(s.wo, wi).pdf * cell * std::sin(theta);
            expected[(i / kInner) * kColumns + j / kInner] += p * kCount;
            total += p;
        }
    }
    Random random{seed};
    int deltas = 0, rejected = 0;
    for (int n = 0; n < kCount; ++n) {
        const float u_lobe = random.next();
        const auto d = bsdf.sample(s.wo, u_lobe, random.next_2d());
        if (!d) {
            ++rejected;
        } else if (d->specular) {
            ++deltas;
        } else {
            const Vec3f l = s.frame.to_local(d->wi);
            const double phi = atan2(l.y, l.x) / (2 * kPiD);
            const double theta = acos(std::clamp(l.z, -1.f, 1.f));
            const int i = std::min(kRows - 1, static_cast<int>(theta / kPiD * kRows));
            const int j = std::min(
                kColumns - 1, static_cast<int>((phi < 0 ? phi + 1 : phi) * kColumns));
            observed[i * kColumns + j] += 1;
        }
    }
    if (std::abs(total - 1 + static_cast<double>(rejected) / kCount) > 0.008) return 0;
    if (rejected == kCount)
        return 1;  // no samples, as the density predicts
    // Delta lobes and failed samples form a cell, unless their expected number is a rounding
    // error.
    expected.back() = (delta + std::max(0.0, 1 - total)) * kCount;
    observed.back() = deltas + rejected;
    if (expected.back() < 0.001 * kCount && observed.back() < 0.002 * kCount)
        expected.back() = observed.back() = 0;
    return chi_square_test(observed, expected).p_value;
}

/// Largest relative difference between a sample's weight and evaluate / pdf, and between
/// the densities.
template <typename B>
double weight_deviation(const B& bsdf, const Setting& s, std::uint64_t seed) {
    Random random{seed};
    double worst = 0;
    for (int n = 0; n < 2000; ++n) {
        const float u_lobe = random.next();
        const auto d = bsdf.sample(s.wo, u_lobe, random.next_2d());
        if (!d || d->specular) continue;
        const Evaluation e = bsdf.evaluate_with_pdf(s.wo, d->wi);
        worst = std::max(worst, std::abs(d->pdf / static_cast<double>(e.pdf) - 1));
        for (int k = 0; k < kWavelengths; ++k)
            worst = std::max(
                worst, std::abs(d->weight[k] - e.f_cos[k] / static_cast<double>(e.pdf)) /
                           (1e-3 + d->weight[k]));
        worst = std::max(worst, std::abs(length(d->wi) - 1.0));
    }
    return worst;
}

/// Asymmetry of f (f n_i^2 for refraction) over random pairs: sum of |f(a,b) - f(b,a)| over the sum of f. (A single
/// pair near total reflection is accurate only to 1 % in float.) `ns`: normal for the cosines.
template <typename B>
double asymmetry(const B& bsdf, Vec3f ns, Vec3f ng, float ior, std::uint64_t seed) {
    Random random{seed};
    double difference = 0, sum = 0;
    for (int n = 0; n < 5000; ++n) {
        const Vec3f a = random.direction(), b = random.direction();
        const float cos_a = std::abs(dot(ns, a)), cos_b = std::abs(dot(ns, b));
        if (std::min(cos_a, cos_b) < 0.01f) continue;
        const float index_a = dot(ng, a) > 0 ? 1 : ior,
                    index_b = dot(ng, b) > 0 ? 1 : ior;
        const Spectrum ab = bsdf.evaluate(a, b) * (index_b * index_b / cos_b);
        const Spectrum ba = bsdf.evaluate(b, a) * (index_a * index_a / cos_a);
        for (int k = 0; k < kWavelengths; ++k) {
            difference += std::abs(static_cast<double>(ab[k]) - ba[k]);
            sum += std::max(ab[k], ba[k]);
        }
    }
    return sum > 0 ? difference / sum : 0;
}

}  // namespace dg::check
