#include "render/flare/live/wavelength_pick.h"

#include <doctest/doctest.h>

using namespace dg;

namespace {

using Transmittance = std::array<float, LiveSource::kNodes>;

/// Weighted mean of f(place) over samples.
template <typename F>
double mean(const WavelengthPick& pick, const F& f) {
    constexpr int kCount = 100000;
    double sum = 0;
    for (int i = 0; i < kCount; ++i) {
        const auto picked = pick((float(i) + 0.5f) / kCount);
        sum += double(picked.weight) * f(picked.place) / kCount;
    }
    return sum;
}

Transmittance violet() {
    Transmittance s{};
    for (int k = 0; k < 5; ++k) s[k] = 1;   // up to 430 nm
    return s;
}

}  // namespace

TEST_CASE("picked wavelengths bring the same light as even ones") {
    Transmittance uneven{};
    for (int k = 0; k < LiveSource::kNodes; ++k) uneven[k] = float(1 + k % 3) * 1e-4f;
    for (const Transmittance& s : {Transmittance{}, violet(), uneven}) {
        const WavelengthPick pick(s);
        CHECK(mean(pick, [](float) { return 1.0; }) == doctest::Approx(1).epsilon(1e-3));
        CHECK(mean(pick, [](float u) { return double(u); }) == doctest::Approx(0.5).epsilon(1e-3));
        CHECK(mean(pick, [](float u) { return double(u) * u; }) == doctest::Approx(1 / 3.0).epsilon(1e-3));
    }
}

TEST_CASE("wavelengths that pass are picked more often") {
    const WavelengthPick pick(violet());
    int of_first = 0;
    for (int i = 0; i < 1000; ++i) of_first += LiveSource::nm(pick((float(i) + 0.5f) / 1000).place) < 470;
    int even = 0;
    for (int i = 0; i < 1000; ++i) even += LiveSource::nm((float(i) + 0.5f) / 1000) < 470;
    CHECK(of_first > 2 * even);
}

TEST_CASE("places of picks are below one") {
    for (const Transmittance& s : {Transmittance{}, violet()})
        for (const float u : {0.f, 0.5f, kBelowOne}) {
            const auto picked = WavelengthPick(s)(u);
            CHECK(picked.place >= 0);
            CHECK(picked.place < 1);
        }
}
