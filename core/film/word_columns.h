// word_columns.h -- words of a film's sums without those that are 0 in every pixel, as most of them are.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// Columns of pixels with `each` words, at least one, that are not 0 everywhere; in rising order.
std::vector<std::uint32_t> used_columns(std::span<const std::uint32_t> words, std::size_t each);
/// Words of these columns, pixel by pixel; `to` has room for as many.
void take_columns(std::span<const std::uint32_t> words, std::size_t each, std::span<const std::uint32_t> columns,
                  std::span<std::uint32_t> to);

}  // namespace dg
