// meshopt_test.cpp -- streams written by hand from the specification, and malformed streams.
#include "codec/meshopt.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "math/hash.h"

using namespace dg;

namespace {

using Vec = std::vector<std::uint8_t>;

Vec join(std::initializer_list<Vec> parts) {
    Vec all;
    for (const Vec& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<std::uint32_t> words(const Vec& bytes) {
    std::vector<std::uint32_t> out(bytes.size() / 4);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        out[i / 4] |= std::uint32_t(bytes[i]) << (i % 4 * 8);
    return out;
}

// Example of the specification: 16 deltas of 4 bits, two of them as literal bytes.
const Vec kExample = {0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
constexpr int kDeltas[16] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};

/// Stride 4, one group: the example in byte 0, zeros in bytes 1 to 3; the baseline is 10 20 30 40.
Vec version0() {
    return join({{0xa0, 0x02}, kExample, {0, 0, 0}, Vec(28, 0), {10, 20, 30, 40}});
}

/// Stride 4, 3 elements: each of the four controls once. Baseline 1 2 3 4; channel mode as given.
Vec version1(std::uint8_t mode) {
    return join({{0xa1, 0b11'10'01'00},
                 {0x01, 0b101, 0x00, 5, 6},  // control 0: one bit each, two sentinels
                 {0x01, 0x1b, 0x00, 0x00, 0x00,
                  9},        // control 1: two bits each: 0 1 2 and a sentinel
                 {7, 8, 9},  // control 3: literal bytes
                 Vec(19, 0),
                 {1, 2, 3, 4, mode}});
}

// 0 1 2 by the table; 0 2 3 and 0 3 4 on the last edge, 4 3 5 on the edge before; 6 0 1 explicit; 6
// 1 9 with an explicit third vertex.
Vec triangles() {
    return join({{0xe1},
                 {0xf0, 0x00, 0x00, 0x10, 0xfe, 0x0f},
                 {0xff, 0x00, 0x02, 16},
                 Vec(16, 0)});
}

}  // namespace

TEST_CASE("the example of the specification") {
    const Vec out = unpack_attributes(version0(), 16, 4);
    REQUIRE(out.size() == 64);
    int value = 10;
    for (int i = 0; i < 16; ++i) {
        value += kDeltas[i];
        CHECK(out[i * 4] == std::uint8_t(value));
        CHECK(out[i * 4 + 1] == 20);
        CHECK(out[i * 4 + 3] == 40);
    }
}

TEST_CASE("the four controls of version 1") {
    // Deltas per byte: 5 0 6 and 0 1 2 and 0 0 0 and 7 8 9, zigzag: 5 = -3, 6 = 3, 1 = -1, 2 = 1
    // ...
    const Vec bytes = unpack_attributes(version1(0), 3, 4);
    CHECK(bytes == Vec{254, 2, 3, 0, 254, 1, 3, 4, 1, 2, 3, 255});
    // In 16 bits: 0x0005 = -3, 0x0100 = 128, 0x0206 = 259; 0x0700 = 896, 0x0800 = 1024, 0x0900.
    const auto pairs = words(unpack_attributes(version1(1), 3, 4));
    CHECK((pairs[0] & 0xffff) == 0x0201 - 3);
    CHECK((pairs[1] & 0xffff) == 0x0201 - 3 + 128);
    CHECK((pairs[2] & 0xffff) == 0x0201 - 3 + 128 + 259);
    CHECK((pairs[2] >> 16) == 0x0403 + 896 + 1024 + 1152);
    // By XOR, stored rotated left by 4: the word 0x07000005 represents 0x50700000.
    const auto turned = words(unpack_attributes(version1(2 | 4 << 4), 3, 4));
    CHECK(turned[0] == (0x04030201u ^ 0x50700000u));
    CHECK(turned[1] == (turned[0] ^ 0x00800010u));
}

TEST_CASE("triangles and indices") {
    CHECK(
        words(unpack_triangles(triangles(), 18, 4)) ==
        std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 3, 4, 4, 3, 5, 6, 0, 1, 6, 1, 9});
    CHECK(unpack_triangles(triangles(), 18, 2).size() == 36);
    // Two independent baselines: +5, +100, +1, -2, and a number of two bytes.
    const Vec stream = join({{0xd1}, {20, 0x91, 0x03, 4, 7, 0xa0, 0x06}, {0, 0, 0, 0}});
    CHECK(words(unpack_indices(stream, 5, 4)) ==
          std::vector<std::uint32_t>{5, 100, 6, 98, 206});
}

TEST_CASE("a stream that is too short or too long, or claims too much, is an error") {
    const auto short_by_one = [](Vec v) { return Vec(v.begin(), v.end() - 1); };
    CHECK_THROWS_AS(unpack_attributes({}, 1, 4), Error);
    CHECK_THROWS_AS(unpack_attributes(short_by_one(version0()), 16, 4), Error);
    CHECK_THROWS_AS(unpack_attributes(version0(), 300, 4), Error);
    CHECK_THROWS_AS(unpack_attributes(version0(), 16, 6), Error);
    CHECK_THROWS_AS(unpack_attributes(version1(3), 3, 4), Error);
    CHECK_THROWS_AS(unpack_triangles(short_by_one(triangles()), 18, 4), Error);
    CHECK_THROWS_AS(unpack_triangles(triangles(), 15, 4), Error);
    CHECK_THROWS_AS(unpack_indices(Vec{0xd1, 0x80, 0, 0, 0, 0}, 1, 4), Error);
    for (const std::size_t count : {std::size_t(3) << 40, std::size_t(3) << 60}) {
        CHECK_THROWS_AS(unpack_attributes(version0(), count, 4), Error);
        CHECK_THROWS_AS(unpack_attributes(version1(0), count, 256), Error);
        CHECK_THROWS_AS(unpack_triangles(triangles(), count, 4), Error);
        CHECK_THROWS_AS(unpack_indices(triangles(), count, 4), Error);
    }
    // An edge that was never pushed.
    CHECK_THROWS_AS(unpack_triangles(join({{0xe1, 0x00}, Vec(16, 0)}), 3, 4), Error);
}

TEST_CASE("damaged bytes give numbers or an error, never more") {
    int errors = 0;
    for (int round = 0; round < 20000; ++round) {
        const int which = round % 3;
        Vec v = which == 0 ? version0() : which == 1 ? version1(0) : triangles();
        for (int k = 0; k < 1 + round % 4; ++k)
            v[hash64(round, k) % v.size()] = std::uint8_t(hash64(round, k, 1));
        if (round % 5 == 0) v.resize(hash64(round, 9) % v.size());
        try {
            const std::size_t size = which == 0   ? unpack_attributes(v, 16, 4).size()
                                     : which == 1 ? unpack_attributes(v, 3, 4).size()
                                                  : unpack_triangles(v, 18, 4).size();
            CHECK(size == (which == 0 ? 64 : which == 1 ? 12 : 72));
        } catch (const Error&) {
            ++errors;
        }
    }
    CHECK(errors > 5000);
}
