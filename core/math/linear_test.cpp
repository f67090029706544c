// linear_test.cpp -- least squares and quaternions against exact algebra.
#include <doctest/doctest.h>

#include <vector>

#include "math/error.h"
#include "math/hash.h"
#include "math/linear_solve.h"
#include "math/quaternion.h"

using namespace dg;

namespace {

std::vector<double> noise(std::size_t n, std::uint64_t seed) {
    std::vector<double> v(n);
    for (std::size_t i = 0; i < n; ++i) v[i] = 2 * hash_uniform(seed, i) - 1;
    return v;
}

}  // namespace

TEST_CASE(
    "least squares recovers a known solution, with any number of rows and right-hand "
    "sides") {
    for (const int rows : {5, 64, 65, 500})
        for (const int nrhs : {1, 3}) {
            const int cols = 5;
            const std::vector<double> a = noise(rows * cols, 1),
                                      x = noise(cols * nrhs, 2);
            std::vector<double> b(rows * nrhs);
            for (int i = 0; i < rows; ++i)
                for (int k = 0; k < nrhs; ++k)
                    for (int j = 0; j < cols; ++j)
                        b[i * nrhs + k] += a[i * cols + j] * x[j * nrhs + k];
            const std::vector<double> got = least_squares(a, rows, cols, b, nrhs);
            for (std::size_t i = 0; i < x.size(); ++i)
                CHECK(got[i] == doctest::Approx(x[i]).epsilon(1e-10));
        }
}

TEST_CASE("the residual of noisy data is orthogonal to every column") {
    const int rows = 1000, cols = 12;
    const std::vector<double> a = noise(rows * cols, 3), b = noise(rows, 4);
    std::vector<double> x = least_squares(a, rows, cols, b, 1);
    const auto worst = [&] {
        double w = 0;
        for (int j = 0; j < cols; ++j) {
            double s = 0;
            for (int i = 0; i < rows; ++i) {
                double r = b[i];
                for (int k = 0; k < cols; ++k) r -= a[i * cols + k] * x[k];
                s += r * a[i * cols + j];
            }
            w = std::max(w, std::abs(s));
        }
        return w;
    };
    CHECK(worst() < 1e-11);
    x[3] *= 1.02;
    CHECK(worst() > 1e-4);
}

TEST_CASE("badly scaled polynomial columns are solved, dependent ones refused") {
    const int rows = 200, cols = 8;
    std::vector<double> a, b;
    for (int i = 0; i < rows; ++i) {
        const double t = 2.0 * i / (rows - 1) - 1;
        for (int j = 0; j < cols; ++j) a.push_back(std::pow(t, j) * std::pow(10, j));
        b.push_back(std::exp(t));
    }
    const std::vector<double> x = least_squares(a, rows, cols, b, 1);
    CHECK(x[0] == doctest::Approx(1).epsilon(1e-5));
    CHECK(x[1] * 10 == doctest::Approx(1).epsilon(1e-4));
    for (int i = 0; i < rows; ++i)
        a[i * cols + 5] = 2 * a[i * cols + 1] - a[i * cols + 2];
    CHECK_THROWS_WITH_AS(least_squares(a, rows, cols, b, 1),
                         doctest::Contains("column 5"), Error);
    a[7] = std::nan("");
    CHECK_THROWS_AS(least_squares(a, rows, cols, b, 1), Error);
    CHECK_THROWS_AS(least_squares(a, 4, cols, b, 1), Error);
    CHECK_THROWS_AS(least_squares(a, rows + 1, cols, b, 1), Error);
}

TEST_CASE("quaternion: matrix round trip through all four branches, and the product") {
    for (int i = 0; i < 500; ++i) {
        const std::vector<double> v = noise(8, i);
        Quaterniond q = normalize(Quaterniond{v[0], v[1], v[2], v[3] * 0.1});
        const Quaterniond p = normalize(Quaterniond{v[4], v[5], v[6], v[7]});
        const Affine3d m = to_matrix(q);
        CHECK(m.determinant() == doctest::Approx(1));
        const Quaterniond back = from_matrix(m);
        if (q.w < 0) q = -q;
        CHECK(dot(back, q) == doctest::Approx(1).epsilon(1e-12));
        const Vec3d a = (q * p).rotate({1, 2, 3}), b = q.rotate(p.rotate({1, 2, 3}));
        CHECK(length(a - b) < 1e-12);
        CHECK(length(to_matrix(q * p).vector({1, 2, 3}) - a) < 1e-12);
        CHECK(length(q.conjugate().rotate(q.rotate({1, 2, 3})) - Vec3d{1, 2, 3}) < 1e-12);
    }
    const auto quarter = Quaterniond::from_axis_angle({0, 0, 1}, kPiD / 2);
    CHECK(length(quarter.rotate({1, 0, 0}) - Vec3d{0, 1, 0}) < 1e-15);
}

TEST_CASE("slerp turns at constant speed along the shorter arc") {
    const auto a = Quaterniond::from_axis_angle({0, 1, 0}, 0.2);
    for (const double total : {1e-9, 1e-4, 0.5, 3.0}) {
        const auto b = Quaterniond::from_axis_angle({0, 1, 0}, 0.2 + total);
        for (const double t : {0.0, 0.25, 0.5, 1.0}) {
            const auto want = Quaterniond::from_axis_angle({0, 1, 0}, 0.2 + t * total);
            for (const auto& end : {b, -b})
                CHECK(length(slerp(a, end, t).rotate({1, 0, 0}) -
                             want.rotate({1, 0, 0})) < 1e-12);
        }
    }
}
