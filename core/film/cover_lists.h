// cover_lists.h -- coverage of each pixel by each object: a list of exact sums per pixel.
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

/// Weight of coverage in whole steps of 2^-30: sums of 2^33 samples of weight 1 fit. NaN becomes 0.
std::int64_t coverage_steps(float weight);

/// The sums are integers, and entries are read in the order of their objects, so the result does not depend on the order
/// of samples. Memory: 4 bytes per pixel, and 16 for each object in it.
class CoverLists {
  public:
    /// Coverage of one pixel by one object, in steps.
    struct Entry {
        std::uint32_t object;
        std::int64_t steps;
        friend bool operator==(const Entry&, const Entry&) = default;
    };
    static constexpr std::size_t kPixelBytes = 4, kEntryBytes = 16;

    explicit CoverLists(std::size_t pixels);
    /// Threads may add at the same time, but not to the same pixel.
    void add(std::size_t pixel, std::uint32_t object, std::int64_t steps);
    /// Adds the lists of another film with the same number of pixels.
    void add(const CoverLists& other);
    /// Entries of a pixel, by rising object, without sums of 0.
    std::vector<Entry> of(std::size_t pixel) const;

    /// All entries, in rows of `width` pixels: column, object, lower and upper half of the sum. Rows are padded to the
    /// longest with entries of column kNowhere.
    static constexpr std::uint32_t kNowhere = 0xffffffffu;
    static constexpr std::size_t kEntryWords = 4;
    std::vector<std::uint32_t> words(std::size_t width) const;
    /// Replaces all entries. Throws Error unless the words are rows as words() makes them, sorted by column and object.
    void set_words(std::span<const std::uint32_t> words, std::size_t width);

  private:
    struct Node {
        std::int64_t steps;
        std::uint32_t object, next;   // index of the next node of the pixel; 0: none
    };
    static_assert(sizeof(Node) == kEntryBytes);
    /// Nodes are stored in chunks, each twice as large as the last, so that no node is ever moved.
    static constexpr int kFirstBits = 10, kChunks = 33 - kFirstBits;
    static int chunk_of(std::uint64_t place);
    Node& node(std::uint32_t place) const;
    std::uint32_t new_node();

    std::vector<std::uint32_t> heads_;   // index of the first node of each pixel; 0: none
    std::array<std::atomic<Node*>, kChunks> chunks_{};
    std::array<std::unique_ptr<Node[]>, kChunks> kept_;
    std::atomic<std::uint64_t> used_ = 1;
    std::mutex growing_;
};

}  // namespace dg
