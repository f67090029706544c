// list_rows.h -- rows of bytes with lists that store their length in front, as in PLY files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/bytes.h"

namespace dg {

/// Type of a list's length; none: the field is a number.
enum class LengthType { none, i1, u1, i2, u2, i4, u4, i8, u8, f8 };

/// Field of a row: a number of `size` bytes, or a list of numbers preceded by its length.
struct RowField {
    std::size_t size;
    LengthType length = LengthType::none;
    bool swapped = false;  ///< The length has the opposite byte order of this machine.
};

/// Maximum size of a row in bytes; it keeps list lengths within 32 bits.
constexpr std::size_t kMostRow = std::size_t(1) << 30;

/// List lengths of consecutive rows.
struct ListLengths {
    std::vector<std::uint32_t> lengths;  ///< Lengths in the first row, then in the next.
    /// Number of complete rows; 0 if `count` rows with empty lists exceed the data.
    std::size_t rows = 0;
    std::size_t end = 0;  ///< Offset of the end of the last complete row.
};

/// Scans `count` rows by their list lengths. Throws Error for a length that is not a non-negative
/// whole number, and for a row larger than kMostRow.
ListLengths list_lengths(Bytes data, std::size_t begin, std::size_t count,
                         std::span<const RowField> fields);

/// Copies a field of all rows found by `list_lengths`, in order. Throws Error unless the rows are
/// inside the data and fill `out`.
void copy_field(Bytes data, std::size_t begin, std::span<const RowField> fields,
                std::span<const std::uint32_t> lengths, std::size_t field,
                std::span<std::uint8_t> out);

}  // namespace dg
