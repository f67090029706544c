#include "codec/list_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace dg {
namespace {

constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 8};

std::size_t size_of(LengthType type) {
    return kSizes[int(type)];
}

template <typename T>
T number(const std::uint8_t* at, bool swapped) {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, at, sizeof(T));
    if (swapped) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// Converts a number to a length: negative if it is not a whole number, clamped to the largest
/// integer.
std::int64_t whole(std::uint64_t value) {
    return std::int64_t(
        std::min(value, std::uint64_t(std::numeric_limits<std::int64_t>::max())));
}
std::int64_t whole(double value) {
    if (!(value >= 0 && std::isfinite(value) && value == std::floor(value))) return -1;
    return std::int64_t(std::min(value, 0x1p62));
}

/// Length of the list at `at`; negative if invalid.
std::int64_t length_at(const std::uint8_t* at, const RowField& field) {
    switch (field.length) {
        case LengthType::none:
            break;
        case LengthType::i1:
            return std::int8_t(*at);
        case LengthType::u1:
            return *at;
        case LengthType::i2:
            return number<std::int16_t>(at, field.swapped);
        case LengthType::u2:
            return number<std::uint16_t>(at, field.swapped);
        case LengthType::i4:
            return number<std::int32_t>(at, field.swapped);
        case LengthType::u4:
            return number<std::uint32_t>(at, field.swapped);
        case LengthType::i8:
            return number<std::int64_t>(at, field.swapped);
        case LengthType::u8:
            return whole(number<std::uint64_t>(at, field.swapped));
        case LengthType::f8:
            return whole(number<double>(at, field.swapped));
    }
    return 1;
}

/// Size of a row with empty lists, in bytes. Throws Error unless all numbers have 1 to 8 bytes.
std::size_t least_size(std::span<const RowField> fields) {
    std::size_t least = 0;
    for (const RowField& field : fields) {
        if (field.size == 0 || field.size > 8)
            throw input_error("rows", "numbers", "1 to 8 bytes",
                              std::to_string(field.size));
        least += field.length == LengthType::none ? field.size : size_of(field.length);
    }
    if (least == 0) throw input_error("rows", "fields", "at least one", "none");
    return least;
}

[[noreturn]] void refuse(const std::uint8_t* at, const RowField& field) {
    std::ostringstream shown;
    if (field.length != LengthType::f8)
        shown << length_at(at, field);
    else if (const auto length = number<double>(at, field.swapped); std::isnan(length))
        shown << "nan";
    else
        shown << length;
    throw Error("wanted a whole number as the length of a list, got " + shown.str());
}

/// Writes the list lengths of the row at `at` and advances past it; returns false if the data ends
/// first.
bool take_row(Bytes data, std::size_t& at, std::span<const RowField> fields,
              std::uint32_t*& lengths) {
    const std::size_t begin = at;
    for (const RowField& field : fields) {
        const std::size_t head = size_of(field.length);
        if (head > data.size() - at) return false;
        const std::int64_t length = length_at(data.data() + at, field);
        if (length < 0) refuse(data.data() + at, field);
        at += head;
        const std::size_t left = data.size() - at;
        if (std::size_t(length) > left || std::size_t(length) * field.size > left)
            return false;
        at += std::size_t(length) * field.size;
        if (at - begin > kMostRow)
            throw Error("wanted rows of at most " + std::to_string(kMostRow) +
                        " bytes, got more");
        if (field.length != LengthType::none) *lengths++ = std::uint32_t(length);
    }
    return true;
}

}  // namespace

ListLengths list_lengths(Bytes data, std::size_t begin, std::size_t count,
                         std::span<const RowField> fields) {
    ListLengths found;
    found.end = begin;
    if (begin > data.size() || count > (data.size() - begin) / least_size(fields))
        return found;
    const auto lists = std::size_t(std::ranges::count_if(
        fields, [](const RowField& one) { return one.length != LengthType::none; }));
    found.lengths.resize(count * lists);
    std::uint32_t* next = found.lengths.data();
    while (found.rows < count) {
        std::size_t at = found.end;
        if (!take_row(data, at, fields, next)) break;
        found.end = at;
        ++found.rows;
    }
    found.lengths.resize(found.rows * lists);
    return found;
}

void copy_field(Bytes data, std::size_t begin, std::span<const RowField> fields,
                std::span<const std::uint32_t> lengths, std::size_t field,
                std::span<std::uint8_t> out) {
    least_size(fields);
    ByteReader from(data, "rows");
    from.take(begin);
    std::size_t to = 0;
    for (std::size_t next = 0; next < lengths.size();) {
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const bool is_list = fields[i].length != LengthType::none;
            if (is_list && next == lengths.size())
                throw input_error("rows", "lengths", "one for each list", "fewer");
            from.take(size_of(fields[i].length));
            const Bytes values =
                from.take((is_list ? lengths[next++] : 1) * fields[i].size);
            if (i != field) continue;
            if (values.size() > out.size() - to)
                throw input_error("rows", "room", "room for all values", "less");
            std::copy(values.begin(), values.end(), out.begin() + to);
            to += values.size();
        }
    }
    if (to != out.size())
        throw input_error("rows", "room", std::to_string(to) + " bytes",
                          std::to_string(out.size()));
}

}  // namespace dg
