// word_columns.h -- the used words of the sums of a film; most words are 0 in every pixel.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dg {

/// Indices of the words of a pixel that at least one pixel uses (not 0), in rising order.
std::vector<std::uint32_t> used_columns(std::span<const std::uint32_t> words, std::size_t words_per_pixel);
/// Copies the words of these columns, pixel by pixel, into `to`.
void take_columns(std::span<const std::uint32_t> words, std::size_t words_per_pixel,
                  std::span<const std::uint32_t> columns, std::span<std::uint32_t> to);

}  // namespace dg
