// word_columns.h -- words of a film's sums without those that are 0 in every pixel, as most of them are.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

struct WordColumns {
    std::vector<std::uint32_t> columns;   // that are kept, in rising order
    std::vector<std::uint32_t> words;     // of these, pixel by pixel
};

/// Words of pixels with `each` words, at least one, without the columns of zeros.
WordColumns word_columns(std::span<const std::uint32_t> words, std::size_t each);

}  // namespace dg
