// cover_lists.h -- how much of each pixel each object covers: a list of exact sums per pixel, as long as it has to be.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace dg {

/// Whole steps of 2^-30 of a weight of coverage: 2^33 samples of white fit. A weight that is no number has none.
std::int64_t coverage_steps(float weight);

/// Sums are integers and are read in the order of the objects, so they depend on no order of adding. 4 bytes per pixel,
/// and 16 for each object in it.
class CoverLists {
  public:
    /// One object in one pixel.
    struct Entry {
        std::uint32_t object;
        std::int64_t steps;
        friend bool operator==(const Entry&, const Entry&) = default;
    };
    static constexpr std::size_t kPixelBytes = 4, kEntryBytes = 16;

    explicit CoverLists(std::size_t pixels);
    /// From any thread, but from one at a time for each pixel.
    void add(std::size_t pixel, std::uint32_t object, std::int64_t steps);
    /// Adds the lists of as many pixels.
    void add(const CoverLists& other);
    /// Entries of a pixel, by rising object, without sums of 0.
    std::vector<Entry> of(std::size_t pixel) const;

    /// All that there is in rows of `width` pixels, each row as long as the longest: of each entry its column, its object,
    /// and the lower and upper half of its sum. Empty places at the end of a row have the column kNowhere.
    static constexpr std::uint32_t kNowhere = 0xffffffffu;
    static constexpr std::size_t kEntryWords = 4;
    std::vector<std::uint32_t> words(std::size_t width) const;
    /// Replaces everything. Throws Error unless they are rows of such entries, in rising order.
    void set_words(std::span<const std::uint32_t> words, std::size_t width);

  private:
    struct Node {
        std::int64_t steps;
        std::uint32_t object, next;   // place of the next node of the pixel; 0: none
    };
    static_assert(sizeof(Node) == kEntryBytes);
    /// Nodes lie in chunks, each twice as large as the one before: none is ever moved.
    static constexpr int kFirstBits = 10, kChunks = 33 - kFirstBits;
    static int chunk_of(std::uint64_t place);
    Node& node(std::uint32_t place) const;
    std::uint32_t new_node();

    std::vector<std::uint32_t> heads_;   // place of each pixel's first node; 0: none
    std::array<std::atomic<Node*>, kChunks> chunks_{};
    std::array<std::unique_ptr<Node[]>, kChunks> kept_;
    std::atomic<std::uint64_t> used_ = 1;
    std::mutex growing_;
};

}  // namespace dg
