// text_numbers_test.cpp -- parsing of numbers, and words at which it stops.
#include "codec/text_numbers.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "math/hash.h"

using namespace dg;

namespace {

Bytes bytes(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

TEST_CASE("numbers in text, with all white space and signs") {
    const std::string text = " 1\t-2.5\r\n+3e2\v.5\f7. \n-0 1E-2\n";
    const auto found = text_floats(bytes(text));
    CHECK(found.values == std::vector<double>{1, -2.5, 300, 0.5, 7, 0, 0.01});
    CHECK(std::signbit(found.values[5]));
    CHECK(found.end == text.size());
    const std::string whole = "7 -8 +9 -9223372036854775808";
    CHECK(text_integers(bytes(whole)).values ==
          std::vector<std::int64_t>{7, -8, 9, std::numeric_limits<std::int64_t>::min()});
    CHECK(text_floats({}).values.empty());
    CHECK(text_floats(bytes("  \n")).end == 3);
}

TEST_CASE("numbers are the nearest to their digits") {
    const auto is = [](const char* text, double wanted) {
        return text_floats(bytes(text)).values.at(0) == wanted;
    };
    CHECK(is("0.1000000000000000055511151231257827", 0.1));
    CHECK(is("9007199254740993", 9007199254740992.0));  // ties to even
    CHECK(is("9007199254740993.00000000001", 9007199254740994.0));
    CHECK(is("1.7976931348623157e308", std::numeric_limits<double>::max()));
    CHECK(is("2.2250738585072014e-308", std::numeric_limits<double>::min()));
    for (std::size_t i = 0; i < 2000; ++i) {  // 17 digits reproduce each double
        const double value =
            std::ldexp(double(hash64(i, 1)), int(hash64(i, 2) % 200) - 160);
        char word[40];
        std::snprintf(word, sizeof word, "%.17g", value);
        CHECK(is(word, value));
    }
}

TEST_CASE("reading stops at the first word that is no plain number") {
    for (const std::string word :
         {"inf", "nan", "-nan(1)", "0x10", "1_000", "1,5", "1e", "e5", "+", "-", ".",
          "--1", "+-1", "1e999", "1f", "1/2"}) {
        CAPTURE(word);
        const auto found = text_floats(bytes("1 2 " + word + " 3"));
        CHECK(found.values.size() == 2);
        CHECK(found.end == 4);
    }
    for (const std::string word : {"1.0", "9223372036854775808", "1e3", "0x1", "+"}) {
        CAPTURE(word);
        CHECK(text_integers(bytes("5\n" + word)).end == 2);
    }
    CHECK(text_floats(bytes(std::string("1\0 2", 4))).end == 0);
}
