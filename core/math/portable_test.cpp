// portable_test.cpp -- C library functions used by the core give the same bits as glibc 2.36, 2.41
// and 2.43. If a newer release fails here, images would change: add a replacement to portable.h.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "math/hash.h"
#include "math/portable.h"

using namespace dg;

namespace {

template <typename T>
std::uint64_t bits(T value) {
    if constexpr (sizeof(T) == 4) return std::bit_cast<std::uint32_t>(value);
    else return std::bit_cast<std::uint64_t>(value);
}

/// Hash of the bits of 200,000 values; arguments are uniform over [low, high].
template <typename T>
std::uint64_t fingerprint(T low, T high, const std::function<T(T, T)>& f) {
    std::uint64_t all = 0;
    for (std::uint32_t i = 0; i < 200000; ++i) {
        const T x = low + (high - low) * T(hash_uniform(1, i)), y = low + (high - low) * T(hash_uniform(2, i));
        all = (all ^ bits(f(x, y))) * 1099511628211ull;   // FNV-1a
    }
    return all;
}

bool is_judged() {
#if defined(__GLIBC__) && defined(__x86_64__)
    return __builtin_cpu_supports("fma");   // otherwise the library takes other code paths, with other bits
#else
    return false;
#endif
}

}  // namespace

TEST_CASE("functions of the C library have the same bits in its releases") {
    using F = float;
    using D = double;
    const auto f = [](const char* name, std::uint64_t wanted, F low, F high, std::function<F(F, F)> function) {
        const std::uint64_t got = fingerprint<F>(low, high, function);
        CAPTURE(std::string(name));
        if (is_judged()) CHECK(got == wanted);
    };
    const auto d = [](const char* name, std::uint64_t wanted, D low, D high, std::function<D(D, D)> function) {
        const std::uint64_t got = fingerprint<D>(low, high, function);
        CAPTURE(std::string(name));
        if (is_judged()) CHECK(got == wanted);
    };
    f("acos", 0x019f2a32e593dc1e, -1, 1, [](F x, F) { return dg::acos(x); });
    f("asin", 0x697b6e6fcd7446e0, -1, 1, [](F x, F) { return dg::asin(x); });
    f("asinh", 0xb70aae4ef1eeec24, -50, 50, [](F x, F) { return dg::asinh(x); });
    f("atan2", 0x621413c6c4bccc20, -5, 5, [](F x, F y) { return dg::atan2(x, y); });
    f("cos", 0x396bb8afc14c8e79, -50, 50, [](F x, F) { return std::cos(x); });
    f("sin", 0x44756145d61a47c5, -50, 50, [](F x, F) { return std::sin(x); });
    f("exp", 0xa945d98402aa4350, -40, 20, [](F x, F) { return std::exp(x); });
    f("exp2", 0x4ac02e4e320eb84e, -40, 20, [](F x, F) { return std::exp2(x); });
    f("log", 0xbd49b8bc9f215088, 1e-6f, 50, [](F x, F) { return std::log(x); });
    f("log2", 0x16e357c39dc7d08e, 1e-6f, 50, [](F x, F) { return std::log2(x); });
    f("pow", 0xadf1a73a078839bf, 1e-3f, 5, [](F x, F y) { return std::pow(x, y); });
    d("acos", 0x2c5ed7d736589172, -1, 1, [](D x, D) { return dg::acos(x); });
    d("asin", 0x23c204632bffbfa1, -1, 1, [](D x, D) { return dg::asin(x); });
    d("atan", 0xd0d10535cac0ff74, -20, 20, [](D x, D) { return dg::atan(x); });
    d("atan2", 0x9e572ca115b4e3df, -5, 5, [](D x, D y) { return dg::atan2(x, y); });
    d("cos", 0xd044f530946916de, -50, 50, [](D x, D) { return std::cos(x); });
    d("sin", 0xa4d94a46c381dd79, -50, 50, [](D x, D) { return std::sin(x); });
    d("tan", 0x94c0469234a66d02, -50, 50, [](D x, D) { return std::tan(x); });
    d("exp", 0x1d7becb72aa1afe4, -40, 20, [](D x, D) { return std::exp(x); });
    d("exp2", 0x4b76e1f0d64aee33, -40, 20, [](D x, D) { return std::exp2(x); });
    d("expm1", 0x8015733114356959, -2, 2, [](D x, D) { return std::expm1(x); });
    d("log", 0x35f4f6a2f8a8b667, 1e-6, 50, [](D x, D) { return std::log(x); });
    d("log1p", 0xc1248cc1bcfb1488, -0.9, 9, [](D x, D) { return std::log1p(x); });
    d("log2", 0x3badd10c364025e6, 1e-6, 50, [](D x, D) { return std::log2(x); });
    d("pow", 0x609a32d7a84c7bd0, 1e-3, 5, [](D x, D y) { return std::pow(x, y); });
}

TEST_CASE("inverse functions of float are the correctly rounded ones") {
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const float x = 2 * float(hash_uniform(3, i)) - 1;
        const long double exact = std::acos((long double)(x));
        CHECK(dg::acos(x) == float(exact));
        CHECK(dg::atan2(x, 0.5f) == float(std::atan2((long double)(x), 0.5L)));
    }
    CHECK(dg::hypot(3.0, 4.0) == 5.0);
    CHECK(dg::atan(1.0) == std::atan(1.0));
}
