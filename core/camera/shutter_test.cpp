// Shutters: curves and their sampling, exposure, and the windows of lines.
#include "camera/shutter.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "math/hash.h"
#include "math/statistics.h"

namespace dg {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

OpeningCurve curve_of(std::vector<double> u, std::vector<double> s) { return OpeningCurve::points(u, s); }

/// p-value of sampled times in 40 cells against the integral of `law`, by the midpoint rule.
double p_value(const OpeningCurve& drawn, const OpeningCurve& law) {
    const int n = 40000, cells = 40, fine = 200;
    std::vector<double> observed(cells), expected(cells);
    for (int i = 0; i < n; ++i)
        ++observed[std::min(cells - 1, int(cells * drawn.sample(hash_uniform(1, i))))];
    for (int i = 0; i < cells * fine; ++i)
        expected[i / fine] += law.at((i + 0.5) / (cells * fine)) / law.mean() * n / (cells * fine);
    return chi_square_test(observed, expected).p_value;
}

ShutterSettings rolling(ScanOrder scan, double exposure, double line) {
    ShutterSettings settings;
    settings.exposure_s = exposure, settings.scan = scan, settings.line_time_s = line;
    return settings;
}

}  // namespace

TEST_CASE("times are drawn by the opening of the shutter") {
    const OpeningCurve trapezoid = OpeningCurve::trapezoid(0.7);
    const OpeningCurve measured = curve_of({0.1, 0.3, 0.3, 0.5, 0.9}, {0, 3, 1, 2, 0});
    for (const OpeningCurve& c : {OpeningCurve(), trapezoid, OpeningCurve::trapezoid(0.5), measured})
        CHECK(p_value(c, c) > 1e-3);
    CHECK(p_value(OpeningCurve::trapezoid(0.75), trapezoid) < 1e-6);
    CHECK(p_value(OpeningCurve(), measured) < 1e-6);
    CHECK(trapezoid.sample(0) == 0);
    CHECK(measured.sample(0) == doctest::Approx(0.1));
    CHECK(measured.sample(1 - 1e-12) == doctest::Approx(0.9));
    CHECK(measured.at(0.05) == 0);
    CHECK(measured.at(0.2) == doctest::Approx(0.5));
    CHECK(measured.at(0.95) == 0);
}

TEST_CASE("the mean of a curve is its efficiency") {
    CHECK(OpeningCurve().mean() == 1);
    for (const double e : {0.5, 0.65, 0.8, 1.0}) {
        CHECK(OpeningCurve::trapezoid(e).mean() == doctest::Approx(e));
        ShutterSettings settings;
        settings.exposure_s = 0.02, settings.curve = OpeningCurve::trapezoid(e);
        CHECK(Shutter(settings, 8, 6).weight() == doctest::Approx(e));
    }
    CHECK(curve_of({0, 1}, {0, 7}).mean() == doctest::Approx(0.5));   // scaled to a maximum of 1
}

TEST_CASE("curves that are none are refused") {
    CHECK_THROWS(OpeningCurve::trapezoid(0.4));
    CHECK_THROWS(OpeningCurve::trapezoid(kNan));
    CHECK_THROWS(curve_of({0.5}, {1}));
    CHECK_THROWS(curve_of({0, 0.6, 0.5}, {0, 1, 0}));
    CHECK_THROWS(curve_of({0, 1}, {0, 0}));
    CHECK_THROWS(curve_of({0.5, 0.5}, {1, 1}));
    CHECK_THROWS(curve_of({0, 1}, {1, kNan}));
    CHECK_THROWS(curve_of({0, 1}, {1, -1}));
    CHECK_THROWS(curve_of({0, 2}, {1, 1}));
    CHECK_THROWS(curve_of(std::vector<double>(5000, 0.5), std::vector<double>(5000, 1.0)));
    CHECK_THROWS(Shutter(rolling(ScanOrder::top, -0.1, 0), 4, 4));
    CHECK_THROWS(Shutter(rolling(ScanOrder::top, 0.1, kNan), 4, 4));
    ShutterSettings leaf = rolling(ScanOrder::top, 0.1, 0.01);
    leaf.leaf = true;
    CHECK_THROWS(Shutter(leaf, 4, 4));
}

TEST_CASE("lines are exposed one after the other, from the side that is asked for") {
    // 10 lines, 2 ms apart, 4 ms each: 22 ms in total.
    struct Case { ScanOrder scan; int x, y; double line; };
    for (const Case& c : {Case{ScanOrder::top, 3, 7, 7}, {ScanOrder::bottom, 3, 7, 2},
                          {ScanOrder::left, 3, 7, 3}, {ScanOrder::right, 3, 7, 6}}) {
        const Shutter s(rolling(c.scan, 0.004, 0.002), 10, 10);
        CHECK(s.duration_s() == doctest::Approx(0.022));
        CHECK(s.draw(c.x, c.y, 0).time * 22 == doctest::Approx(2 * c.line));
        CHECK(s.draw(c.x, c.y, 0.5f).time * 22 == doctest::Approx(2 * c.line + 2));
        const int row = s.scans_columns() ? c.x : c.y;
        for (const double u : {0.0, 0.3, 0.9999})
            CHECK(s.opening(row, s.draw(c.x, c.y, float(u)).time) == 1);
        CHECK(s.opening(row, float((2 * c.line - 0.1) / 22)) == 0);
        CHECK(s.opening(row, float((2 * c.line + 4.1) / 22)) == 0);
        CHECK(s.opening(-1, 0.5f) == 0);
        CHECK(s.opening(10, 0.5f) == 0);
    }
    const Shutter frozen(rolling(ScanOrder::bottom, 0, 0.002), 4, 30);
    for (int y = 0; y < 30; ++y) {
        const float time = frozen.draw(0, y, 0.7f).time;
        CHECK(time == doctest::Approx((29 - y) / 29.0));
        for (int row = 0; row < 30; ++row) CHECK(frozen.opening(row, time) == (row == y ? 1 : 0));
    }
    CHECK(Shutter().duration_s() == 0);
    CHECK(Shutter().draw(5, 5, 0.7f).time == 0);
    CHECK_FALSE(Shutter().rolls());
}

TEST_CASE("times of no line in particular expose each line as its own times do") {
    for (const double exposure : {0.0, 0.002, 0.01, 0.5})   // an instant; separate, touching and overlapping
                                                            // windows
        for (const ScanOrder scan : {ScanOrder::top, ScanOrder::right}) {
            ShutterSettings settings = rolling(scan, exposure, 0.01);
            settings.curve = OpeningCurve::trapezoid(0.75);
            const Shutter shutter(settings, 12, 8);
            const int lines = scan == ScanOrder::top ? 8 : 12, n = 40000;
            std::vector<double> exposed(lines);
            for (int i = 0; i < n; ++i) {
                const float time = shutter.draw_any(float((i + 0.5) / n)).time;
                for (int row = 0; row < lines; ++row) exposed[row] += shutter.opening(row, time) / n;
            }
            // With times of density q, each line receives the integral of s over its window; an
            // instant counts as 1.
            const double mean = exposure > 0 ? shutter.weight() : 1;
            for (const double e : exposed)
                CHECK(e / shutter.any_share() == doctest::Approx(mean).epsilon(0.01));
        }
    const Shutter at_once(ShutterSettings{0.1}, 12, 8);
    CHECK(at_once.any_share() == 1);
    CHECK(at_once.draw_any(0.3f).time == at_once.draw(3, 5, 0.3f).time);
}

TEST_CASE("a leaf's moments are even, and know how far the iris is open") {
    ShutterSettings settings;
    settings.exposure_s = 0.01, settings.leaf = true;
    settings.curve = OpeningCurve::trapezoid(0.75);
    const Shutter s(settings, 4, 4);
    CHECK(s.weight() == 1);
    CHECK(s.draw(1, 1, 0.125f).time == 0.125f);
    CHECK(s.draw(1, 1, 0.125f).iris_opening == doctest::Approx(0.5));
    CHECK(s.draw(1, 1, 0.5f).iris_opening == 1);
}

TEST_CASE("beside the frame lines are exposed as the nearest one of it") {
    for (const ScanOrder scan : {ScanOrder::top, ScanOrder::bottom, ScanOrder::left, ScanOrder::right}) {
        const Shutter own({1e-3, {}, scan, 1e-3}, 6, 8);
        const Shutter larger = own.within(3, 2);
        const bool columns = own.scans_columns();
        const int lines = columns ? 6 : 8, before = columns ? 3 : 2;
        CHECK(larger.duration_s() == own.duration_s());
        for (int line = 0; line < lines + before + 4; ++line) {
            const int nearest = std::clamp(line - before, 0, lines - 1);
            const Moment there = larger.draw(line, line, 0.3f), here = own.draw(nearest, nearest, 0.3f);
            CHECK(there.time == here.time);
            CHECK(larger.opening(line, there.time) == 1);
            const float middle = own.draw(lines / 2, lines / 2, 0.5f).time;
            CHECK(larger.opening(line, middle) == own.opening(nearest, middle));
            CHECK(larger.opens_at({line + 0.5, line + 0.5}) == own.opens_at({nearest + 0.5, nearest + 0.5}));
        }
    }
}

}  // namespace dg
