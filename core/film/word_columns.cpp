#include "film/word_columns.h"

namespace dg {

WordColumns word_columns(std::span<const std::uint32_t> words, std::size_t each) {
    std::vector<std::uint32_t> any(each);
    for (std::size_t i = 0; i + each <= words.size(); i += each)
        for (std::size_t k = 0; k < each; ++k) any[k] |= words[i + k];
    WordColumns found;
    for (std::size_t k = 0; k < each; ++k)
        if (any[k]) found.columns.push_back(std::uint32_t(k));
    found.words.resize(words.size() / each * found.columns.size());
    std::uint32_t* to = found.words.data();
    for (std::size_t i = 0; i + each <= words.size(); i += each)
        for (const std::uint32_t column : found.columns) *to++ = words[i + column];
    return found;
}

}  // namespace dg
