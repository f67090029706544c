#include "spectrum/sampled_spectrum.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/error.h"

using namespace dg;

TEST_CASE("linear between samples, constant beyond the ends") {
    const std::vector<double> nm{400, 500, 510}, values{1, 3, 2};
    const SampledSpectrum s(nm, values);
    CHECK(s.at(380) == 1);
    CHECK(s.at(450) == doctest::Approx(2));
    CHECK(s.at(504.5f) == doctest::Approx(2.55));
    CHECK(s.at(700) == 2);
    CHECK(s.at(9000) == 2);
    CHECK(s.at(Spectrum{400, 425, 505, 780})[1] == doctest::Approx(1.5));
    CHECK(s.least() == 1);
    CHECK(s.most() == doctest::Approx(3));
}

TEST_CASE("a grey spectrum is grey, and a basis curve of the upsampling is its primary") {
    const std::vector<double> one{550}, half{0.5};
    const Rgb grey = SampledSpectrum(one, half).rgb();
    for (int k = 0; k < 3; ++k) CHECK(grey[k] == doctest::Approx(0.5).epsilon(1e-5));
    std::vector<double> nm, red;
    for (int i = 380; i <= 780; ++i) nm.push_back(i), red.push_back(std::max(0.0, rgb_basis(i).x));
    const Rgb r = SampledSpectrum(nm, red).rgb();
    CHECK(r.x == doctest::Approx(1).epsilon(0.01));
    CHECK(std::abs(r.y) < 0.01);
    CHECK(std::abs(r.z) < 0.01);
}

TEST_CASE("spectra that are none are refused") {
    const auto made = [](std::vector<double> nm, std::vector<double> values) { return SampledSpectrum(nm, values); };
    CHECK_THROWS_AS(made({}, {}), Error);
    CHECK_THROWS_AS(made({400}, {1, 2}), Error);
    CHECK_THROWS_AS(made({500, 400}, {1, 2}), Error);
    CHECK_THROWS_AS(made({400, 500}, {1, -2}), Error);
    CHECK_THROWS_AS(made({400, 500}, {1, std::nan("")}), Error);
    CHECK_THROWS_AS(made({400, 500}, {1, 1e300}), Error);
    CHECK(SharedSpectrum(std::make_shared<SampledSpectrum>(made({400}, {1}))) ==
          SharedSpectrum(std::make_shared<SampledSpectrum>(made({600}, {1}))));
    CHECK_FALSE(SharedSpectrum() == SharedSpectrum(std::make_shared<SampledSpectrum>(made({400}, {1}))));
}
