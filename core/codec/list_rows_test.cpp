// list_rows_test.cpp -- scanning and copying of rows with lists, and invalid lengths.
#include "codec/list_rows.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "math/hash.h"

using namespace dg;

namespace {

using Vec = std::vector<std::uint8_t>;
using Lengths = std::vector<std::uint32_t>;

/// Appends a number in the byte order of the machine, or swapped.
template <typename T>
void put(Vec& to, T value, bool swapped = false) {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (swapped) std::ranges::reverse(bytes);
    for (const std::uint8_t byte : bytes) to.push_back(byte);
}

template <typename T>
Vec one_length(T value, int zeros = 0) {
    Vec out;
    put(out, value);
    for (int i = 0; i < zeros; ++i) out.push_back(0);
    return out;
}

Vec copied(const Vec& data, std::size_t begin, const std::vector<RowField>& fields,
           const ListLengths& found, std::size_t field, std::size_t size) {
    Vec out(size);
    copy_field(data, begin, fields, found.lengths, field, out);
    return out;
}

}  // namespace

TEST_CASE("rows by hand: a number, a list of two-byte numbers, a number") {
    const Vec data{9, 9, 7, 2, 10, 11, 20, 21, 5, 8, 0, 6, 1, 1};
    const std::vector<RowField> fields{{1}, {2, LengthType::u1}, {1}};
    const ListLengths found = list_lengths(data, 2, 2, fields);
    CHECK(found.rows == 2);
    CHECK(found.end == 12);
    CHECK(found.lengths == Lengths{2, 0});
    CHECK(copied(data, 2, fields, found, 0, 2) == Vec{7, 8});
    CHECK(copied(data, 2, fields, found, 1, 4) == Vec{10, 11, 20, 21});
    CHECK(copied(data, 2, fields, found, 2, 2) == Vec{5, 6});
}

TEST_CASE_TEMPLATE("lengths of every type in both byte orders", T, std::int8_t,
                   std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                   std::int64_t, std::uint64_t, double) {
    constexpr bool kReal = std::is_floating_point_v<T>;
    const auto type = kReal ? LengthType::f8
                            : LengthType(1 + 2 * std::countr_zero(sizeof(T)) +
                                         (std::is_signed_v<T> ? 0 : 1));
    for (bool swapped : {false, true}) {
        Vec data, wanted;
        Lengths lengths;
        for (std::size_t i = 0; i < 500; ++i) {
            lengths.push_back(hash64(i, 1) % 7);
            put(data, T(lengths.back()), swapped);
            for (std::size_t k = 0; k < 3 * lengths.back(); ++k) {
                data.push_back(std::uint8_t(hash64(i, k)));
                wanted.push_back(data.back());
            }
        }
        const std::vector<RowField> fields{{3, type, swapped}};
        const ListLengths found = list_lengths(data, 0, 500, fields);
        CHECK(found.lengths == lengths);
        CHECK(found.end == data.size());
        CHECK(copied(data, 0, fields, found, 0, wanted.size()) == wanted);
    }
}

TEST_CASE("rows end with the bytes, wherever those are cut") {
    const std::vector<RowField> fields{{4, LengthType::u1}, {1}};
    const Vec data{1, 0, 0, 0, 0, 5, 2, 0, 0, 0, 0, 0, 0, 0, 0, 5};
    for (std::size_t size = 0; size < data.size(); ++size) {
        CAPTURE(size);
        const ListLengths found = list_lengths(Bytes(data).first(size), 0, 2, fields);
        CHECK(found.rows == (size < 6 ? 0 : 1));
        CHECK(found.end == (size < 6 ? 0 : 6));
        CHECK(found.lengths.size() == found.rows);
    }
    CHECK(list_lengths(data, data.size() + 1, 1, fields).rows == 0);
    CHECK(list_lengths(data, 0, std::numeric_limits<std::size_t>::max(), fields).rows ==
          0);
}

TEST_CASE("lengths that lie: larger than the file, negative, broken, none") {
    const auto follow = [](const Vec& data, LengthType type) {
        return list_lengths(data, 0, 1, std::vector<RowField>{{8, type}}).rows;
    };
    CHECK(follow(one_length(std::numeric_limits<std::uint64_t>::max(), 8),
                 LengthType::u8) == 0);
    CHECK(follow(one_length(std::uint64_t(1) << 61, 8), LengthType::u8) ==
          0);  // times 8: 0 in 64 bits
    CHECK(follow(one_length(1e300, 8), LengthType::f8) == 0);
    CHECK_THROWS_WITH(follow(one_length(std::numeric_limits<double>::infinity(), 8), LengthType::f8),
                      doctest::Contains("got inf"));
    CHECK(follow(one_length(1.0, 8), LengthType::f8) == 1);
    CHECK_THROWS_WITH(follow(one_length(-1.0, 8), LengthType::f8),
                      doctest::Contains("length of a list, got -1"));
    CHECK_THROWS_WITH(follow(one_length(2.5, 8), LengthType::f8),
                      doctest::Contains("got 2.5"));
    CHECK_THROWS_WITH(
        follow(one_length(-std::numeric_limits<double>::quiet_NaN(), 8), LengthType::f8),
        doctest::Contains("got nan"));
    CHECK_THROWS_WITH(follow(one_length(std::int8_t(-3), 8), LengthType::i1),
                      doctest::Contains("got -3"));
    CHECK_THROWS_WITH(
        follow(one_length(std::numeric_limits<std::int64_t>::min(), 8), LengthType::i8),
        doctest::Contains("got -9223372036854775808"));
}

TEST_CASE(
    "fields and lengths that do not fit the data are errors, not reads beyond them") {
    const Vec data{2, 1, 2, 1, 3};
    const std::vector<RowField> fields{{1, LengthType::u1}};
    Vec out(3);
    copy_field(data, 0, fields, Lengths{2, 1}, 0, out);
    CHECK(out == Vec{1, 2, 3});
    CHECK_THROWS_WITH(copy_field(data, 0, fields, Lengths{2, 2}, 0, out),
                      doctest::Contains("truncated"));
    CHECK_THROWS_WITH(copy_field(data, 6, fields, Lengths{2}, 0, out),
                      doctest::Contains("truncated"));
    CHECK_THROWS_WITH(copy_field(data, 0, fields, Lengths{2}, 0, out),
                      doctest::Contains("wanted 2 bytes, got 3"));
    CHECK_THROWS_WITH(
        copy_field(data, 0, fields, Lengths{2, 1}, 0, std::span(out).first(2)),
        doctest::Contains("room"));
    CHECK_THROWS_WITH(copy_field(data, 0, fields, Lengths{2, 1}, 1, out),
                      doctest::Contains("wanted 0 bytes"));
    const std::vector<RowField> two{{1, LengthType::u1}, {1, LengthType::u1}};
    CHECK_THROWS_WITH(copy_field(data, 0, two, Lengths{2}, 0, out),
                      doctest::Contains("one for each list"));
    CHECK_THROWS_WITH(copy_field(data, 0, {}, Lengths{2}, 0, out),
                      doctest::Contains("at least one"));
    CHECK_THROWS_WITH(list_lengths(data, 0, 1, std::vector<RowField>{{0}}),
                      doctest::Contains("1 to 8 bytes"));
    CHECK_THROWS_WITH(list_lengths(data, 0, 1, {}), doctest::Contains("at least one"));
}
