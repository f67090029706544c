// text_numbers.h -- fast parsing of many numbers in text.
#pragma once
#include <cstddef>
#include <vector>

#include "codec/bytes.h"

namespace dg {

/// Numbers of a text, up to the first word that is not a number.
template <typename T>
struct TextNumbers {
    std::vector<T> values;
    std::size_t end =
        0;  ///< Offset of that word; the size of the text if there is none.
};

/// Parses words between white space as numbers, rounded to nearest, independent of the locale.
/// Stops at words that only some programs accept as numbers, such as "inf", "0x10" and "1_000", and
/// at numbers out of range.
TextNumbers<double> text_floats(Bytes text);
TextNumbers<std::int64_t> text_integers(Bytes text);

}  // namespace dg
