// list_rows.h -- rows of bytes with lists in them, each with its length in front, as PLY
// files have them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/bytes.h"

namespace dg {

/// Type of the length of a list; none: a field is a number.
enum class LengthType { none, i1, u1, i2, u2, i4, u4, i8, u8, f8 };

/// A field of a row: a number of `size` bytes, or a list of such numbers behind its
/// length.
struct RowField {
    std::size_t size;
    LengthType length = LengthType::none;
    bool swapped = false;  ///< The length has the other byte order than this machine.
};

/// Maximum size of a row, bytes; lengths of lists fit in 32 bits then.
constexpr std::size_t kMostRow = std::size_t(1) << 30;

/// Lengths of the lists of rows that begin at a byte.
struct ListLengths {
    std::vector<std::uint32_t> lengths;  ///< Those of the first row, then of the next.
    /// Rows that are whole; 0 where even empty lists would not leave room for `count`.
    std::size_t rows = 0;
    std::size_t end = 0;  ///< Where the last of these ends.
};

/// Follows `count` rows by the lengths of their lists. Error where a length is no whole
/// number of at least 0, and where a row is larger than kMostRow.
ListLengths list_lengths(Bytes data, std::size_t begin, std::size_t count,
                         std::span<const RowField> fields);

/// Copies one field of all rows that `list_lengths` found, one after the other. Error
/// unless the rows are inside of the data and fill `out`.
void copy_field(Bytes data, std::size_t begin, std::span<const RowField> fields,
                std::span<const std::uint32_t> lengths, std::size_t field,
                std::span<std::uint8_t> out);

}  // namespace dg
