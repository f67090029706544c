// text_numbers.h -- numbers in text, many and fast.
#pragma once
#include <cstddef>
#include <vector>

#include "codec/bytes.h"

namespace dg {

/// Numbers of a text, up to the first word that is none.
template <typename T>
struct TextNumbers {
    std::vector<T> values;
    std::size_t end =
        0;  ///< Where that word begins; the size of the text where all are numbers.
};

/// Reads words between white space as numbers, rounded to the nearest, whatever the
/// locale is. It stops at words that only some programs take for numbers, such as "inf",
/// "0x10" and "1_000", and at numbers out of range.
TextNumbers<double> text_floats(Bytes text);
TextNumbers<std::int64_t> text_integers(Bytes text);

}  // namespace dg
