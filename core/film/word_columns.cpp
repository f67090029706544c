#include "film/word_columns.h"

#include "math/error.h"

namespace dg {

std::vector<std::uint32_t> used_columns(std::span<const std::uint32_t> words, std::size_t words_per_pixel) {
    std::vector<std::uint32_t> any(words_per_pixel), found;
    for (std::size_t i = 0; i + words_per_pixel <= words.size(); i += words_per_pixel)
        for (std::size_t k = 0; k < words_per_pixel; ++k) any[k] |= words[i + k];
    for (std::size_t k = 0; k < words_per_pixel; ++k)
        if (any[k]) found.push_back(std::uint32_t(k));
    return found;
}

void take_columns(std::span<const std::uint32_t> words, std::size_t words_per_pixel,
                  std::span<const std::uint32_t> columns, std::span<std::uint32_t> to) {
    DG_CHECK(to.size(), ==, words.size() / words_per_pixel * columns.size());
    for (const std::uint32_t column : columns) DG_CHECK(column, <, words_per_pixel);
    std::uint32_t* next = to.data();
    for (std::size_t i = 0; i + words_per_pixel <= words.size(); i += words_per_pixel)
        for (const std::uint32_t column : columns) *next++ = words[i + column];
}

}  // namespace dg
