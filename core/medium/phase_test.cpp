#include "medium/phase.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/hash.h"
#include "math/statistics.h"
#include "math/error.h"

namespace dg {
namespace {

const std::vector<std::vector<PhaseLobe>> kPhases{
    {{0, 1}}, {{0.6f, 1}}, {{-0.85f, 2}}, {{0.9f, 3}, {-0.3f, 1}}, {{0.98f, 1}, {0, 1}, {-0.5f, 0.5f}}};

/// Share of a lobe with scattering angles below acos(c): its integral from c to 1 in closed form.
double below(const PhaseLobe& lobe, double c) {
    const double g = lobe.mean_cosine;
    if (std::abs(g) < 1e-6) return (1 - c) / 2;
    return (1 - g * g) / (2 * g) * (1 / (1 - g) - 1 / std::sqrt(1 + g * g - 2 * g * c));
}

Vec3f direction(int stream, int i) {
    const double z = 2 * hash_uniform(stream, 2 * i) - 1, phi = 2 * kPiD * hash_uniform(stream, 2 * i + 1);
    const double r = std::sqrt(1 - z * z);
    return {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
}

/// Chi-square test of sampled angles and azimuths against the integral of the lobes. `wrong`: planted error of the lobe
/// widths.
double p_value(const Phase& phase, float wrong, int stream) {
    constexpr int kTurns = 24, kAround = 8, kCount = 60000;
    std::vector<double> observed(kTurns * kAround), expected(kTurns * kAround);
    const auto edge = [](int i) { return 1 - 2 * std::pow(double(i) / kTurns, 3); };
    for (int i = 0; i < kTurns; ++i)
        for (PhaseLobe lobe : phase.lobes()) {
            lobe.mean_cosine *= wrong;
            const double share = lobe.share * (below(lobe, edge(i + 1)) - below(lobe, edge(i)));
            for (int k = 0; k < kAround; ++k) expected[i * kAround + k] += kCount * share / kAround;
        }
    const Vec3f wo = direction(stream, 1 << 20);
    const Frame frame = Frame::from_normal(-wo);
    for (int n = 0; n < kCount; ++n) {
        const auto u = [&](int k) { return float(hash_uniform(stream, 3 * n + k)); };
        const Vec3f w = frame.to_local(phase.sample(wo, u(0), {u(1), u(2)}));
        int i = 0;
        while (i + 1 < kTurns && w.z < edge(i + 1)) ++i;
        const double around = (std::atan2(w.y, w.x) / kPiD + 1) / 2 * kAround;
        ++observed[i * kAround + std::min(int(around), kAround - 1)];
    }
    return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("directions are drawn by the phase function") {
    for (std::size_t i = 0; i < kPhases.size(); ++i) {
        const Phase phase(kPhases[i]);
        CHECK(p_value(phase, 1, int(i) + 1) > 1e-3);
        if (phase.lobes()[0].mean_cosine != 0) CHECK(p_value(phase, 0.94f, int(i) + 1) < 1e-3);
    }
}

TEST_CASE("a phase function is 1 over all directions, has its mean cosine, and is the same both ways") {
    for (const auto& lobes : kPhases) {
        const Phase phase(lobes);
        constexpr int kSteps = 200000;
        double sum = 0, cosine = 0, mean = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double s = (i + 0.5) / kSteps, turn = 2 * s * s * s, weight = 2 * kPiD * 6 * s * s / kSteps;
            for (const PhaseLobe& lobe : phase.lobes()) {
                const PhaseLobe forward{std::abs(lobe.mean_cosine), 1};
                const double value = lobe.share * forward.value(float(turn));
                sum += weight * value;
                cosine += weight * value * (1 - turn) * (lobe.mean_cosine < 0 ? -1 : 1);
            }
        }
        for (const PhaseLobe& lobe : phase.lobes()) mean += lobe.share * lobe.mean_cosine;
        CHECK(sum == doctest::Approx(1).epsilon(1e-4));
        CHECK(cosine == doctest::Approx(mean).epsilon(1e-4));
        for (int i = 0; i < 20; ++i)
            CHECK(phase.value(direction(7, i), direction(8, i)) == phase.value(direction(8, i), direction(7, i)));
    }
}

TEST_CASE("what is drawn has the value that is asked for") {
    for (const auto& lobes : kPhases) {
        const Phase phase(lobes);
        const Vec3f wo = direction(3, 4);
        for (int i = 0; i < 100; ++i) {
            const float u = (float(i) + 0.5f) / 100;
            const Vec3f wi = phase.sample(wo, u, {1 - u, 0.37f});
            CHECK(std::abs(length(wi) - 1) < 1e-5f);
            CHECK(phase.value(wo, wi) > 0);
        }
    }
}

TEST_CASE("lobes that are none are refused") {
    const auto make = [](std::vector<PhaseLobe> lobes) { return Phase(lobes); };
    CHECK_THROWS_AS(make({}), Error);
    CHECK_THROWS_AS(make({{1, 1}}), Error);
    CHECK_THROWS_AS(make({{0, 0}}), Error);
    CHECK_THROWS_AS(make({{0, -1}, {0, 2}}), Error);
    CHECK_THROWS_AS(make({{std::nanf(""), 1}}), Error);
    CHECK_THROWS_AS(make(std::vector<PhaseLobe>(9, PhaseLobe{0, 1})), Error);
}

}  // namespace dg
