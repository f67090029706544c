#include "film/word_columns.h"

#include "math/error.h"

namespace dg {

std::vector<std::uint32_t> used_columns(std::span<const std::uint32_t> words, std::size_t each) {
    std::vector<std::uint32_t> any(each), found;
    for (std::size_t i = 0; i + each <= words.size(); i += each)
        for (std::size_t k = 0; k < each; ++k) any[k] |= words[i + k];
    for (std::size_t k = 0; k < each; ++k)
        if (any[k]) found.push_back(std::uint32_t(k));
    return found;
}

void take_columns(std::span<const std::uint32_t> words, std::size_t each, std::span<const std::uint32_t> columns,
                  std::span<std::uint32_t> to) {
    DG_CHECK(to.size(), ==, words.size() / each * columns.size());
    for (const std::uint32_t column : columns) DG_CHECK(column, <, each);
    std::uint32_t* next = to.data();
    for (std::size_t i = 0; i + each <= words.size(); i += each)
        for (const std::uint32_t column : columns) *next++ = words[i + column];
}

}  // namespace dg
