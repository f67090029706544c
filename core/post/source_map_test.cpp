#include "post/source_map.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace dg;

TEST_CASE("displacements at any point are those of a cubic, where nodes tell them") {
    constexpr int kColumns = 4, kRows = 3, kTop = 32;
    const auto bend = [](double x, double y) {
        return 1 + 0.02 * x - 3e-4 * x * y + 1e-6 * x * x * x - 2e-6 * y * y * y;
    };
    std::vector<float> nodes, cell(2 * 256, 5.0f);
    for (int j = -1; j < kRows + 2; ++j)
        for (int i = -1; i < kColumns + 2; ++i) {
            nodes.push_back(float(bend(16 * i, kTop + 16 * j)));
            nodes.push_back(float(-2 * bend(16 * i, kTop + 16 * j)));
        }
    std::vector<std::int32_t> exact(kColumns * kRows, -1);
    exact[kColumns + 2] = 0;
    const SourceMap map{kColumns, kRows, kTop, nodes, exact, cell};
    const std::vector<double> points{0,    32, 16,   48,   3.25, 75.5, 63.9, 79.9, 20.7,
                                     40.1, 50, 61.5, 47.9, 50,   32,   48,   -0.1, 40,
                                     64,   40, 10,   31.9, 10,   80};
    const auto found = map.displacements_at(points);
    for (int k = 0; k < 6; ++k) {
        CAPTURE(k);
        const double wanted = bend(points[2 * k], points[2 * k + 1]);
        CHECK(found[2 * k] == doctest::Approx(wanted).epsilon(1e-5));
        CHECK(found[2 * k + 1] == doctest::Approx(-2 * wanted).epsilon(1e-5));
    }
    for (std::size_t k = 12; k < found.size(); ++k) CHECK(std::isnan(found[k]));
}
