#include "film/cover_lists.h"

#include <algorithm>
#include <bit>
#include <string>

#include "math/error.h"

namespace dg {

std::int64_t coverage_steps(float weight) {
    constexpr float kMost = 0x1p20f, kScale = 0x1p30f;
    return weight == weight ? std::int64_t(std::clamp(weight, -kMost, kMost) * kScale) : 0;
}

CoverLists::CoverLists(std::size_t pixels) : heads_(pixels) {}

int CoverLists::chunk_of(std::uint64_t place) {
    return int(std::bit_width(place + (std::uint64_t(1) << kFirstBits))) - 1 - kFirstBits;
}

CoverLists::Node& CoverLists::node(std::uint32_t place) const {
    const int chunk = chunk_of(place);
    const std::uint64_t first = (std::uint64_t(1) << (chunk + kFirstBits)) - (std::uint64_t(1) << kFirstBits);
    return chunks_[chunk].load(std::memory_order_acquire)[place - first];
}

std::uint32_t CoverLists::new_node() {
    const std::uint64_t place = used_.fetch_add(1, std::memory_order_relaxed);
    if (place >= kNowhere) throw Error("film: objects: more than 2^32 of them in all pixels together");
    const int chunk = chunk_of(place);
    if (!chunks_[chunk].load(std::memory_order_acquire)) {
        const std::lock_guard lock(growing_);
        if (!kept_[chunk]) {
            kept_[chunk] = std::make_unique_for_overwrite<Node[]>(std::size_t(1) << (chunk + kFirstBits));
            chunks_[chunk].store(kept_[chunk].get(), std::memory_order_release);
        }
    }
    return std::uint32_t(place);
}

void CoverLists::add(std::size_t pixel, std::uint32_t object, std::int64_t steps) {
    for (std::uint32_t place = heads_[pixel]; place; place = node(place).next)
        if (node(place).object == object) {
            node(place).steps = std::int64_t(std::uint64_t(node(place).steps) + std::uint64_t(steps));
            return;
        }
    const std::uint32_t made = new_node();
    node(made) = {steps, object, heads_[pixel]};
    heads_[pixel] = made;
}

void CoverLists::add(const CoverLists& other) {
    DG_CHECK(heads_.size(), ==, other.heads_.size());
    for (std::size_t i = 0; i < heads_.size(); ++i)
        for (std::uint32_t place = other.heads_[i]; place; place = other.node(place).next)
            add(i, other.node(place).object, other.node(place).steps);
}

std::vector<CoverLists::Entry> CoverLists::of(std::size_t pixel) const {
    std::vector<Entry> found;
    for (std::uint32_t place = heads_[pixel]; place; place = node(place).next)
        if (node(place).steps) found.push_back({node(place).object, node(place).steps});
    std::ranges::sort(found, {}, &Entry::object);
    return found;
}

std::vector<std::uint32_t> CoverLists::words(std::size_t width) const {
    const std::size_t height = heads_.size() / width;
    std::vector<std::vector<std::uint32_t>> rows(height);
    std::size_t longest = kEntryWords;
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x)
            for (const Entry& e : of(y * width + x)) {
                const auto bits = std::uint64_t(e.steps);
                rows[y].insert(rows[y].end(),
                               {std::uint32_t(x), e.object, std::uint32_t(bits), std::uint32_t(bits >> 32)});
            }
        longest = std::max(longest, rows[y].size());
    }
    std::vector<std::uint32_t> all;
    all.reserve(longest * height);
    for (std::vector<std::uint32_t>& row : rows) {
        all.insert(all.end(), row.begin(), row.end());
        for (std::size_t i = row.size(); i < longest; i += kEntryWords) all.insert(all.end(), {kNowhere, 0, 0, 0});
        row = {};
    }
    return all;
}

void CoverLists::set_words(std::span<const std::uint32_t> words, std::size_t width) {
    const std::size_t height = heads_.size() / width, row_size = words.size() / height;
    const auto refuse = [](const std::string& wanted, const std::string& got) {
        throw input_error("film state", "objects", wanted, got);
    };
    if (words.empty() || words.size() % (height * kEntryWords))
        refuse("as many entries in each of " + std::to_string(height) + " rows", std::to_string(words.size()) + " words");
    std::ranges::fill(heads_, 0);
    used_ = 1;
    for (std::size_t y = 0; y < height; ++y) {
        std::uint64_t last = 0;   // smallest key that the next entry may have
        for (std::size_t i = 0; i < row_size; i += kEntryWords) {
            const auto e = words.subspan(y * row_size + i, kEntryWords);
            const std::uint64_t at = std::uint64_t(e[0]) << 32 | e[1];
            if (e[0] == kNowhere && (last = ~std::uint64_t(0))) continue;
            if (e[0] >= width || at < last)
                refuse("columns and objects that increase", std::to_string(e[0]) + ", " + std::to_string(e[1]));
            last = at + 1;
            add(y * width + e[0], e[1], std::int64_t(std::uint64_t(e[3]) << 32 | e[2]));
        }
    }
}

}  // namespace dg
