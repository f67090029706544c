// plane.h -- the stores of layers: records of pixels side by side, or lists of objects.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "film/cover_lists.h"
#include "film/film_layout.h"
#include "film/records.h"
#include "math/cancel.h"
#include "math/error.h"

namespace dg {

/// Words of a layer, 32 bits each, row by row from the top.
struct LayerState {
    std::span<const std::byte> bytes;
    std::size_t entries;               // per row: pixels, or entries of the longest row of lists
    std::vector<std::uint32_t> made;   // owns the words of lists, which are made on demand
};

/// Records of a layer; the records of a pixel are adjacent.
template <LayerRecord R>
class Plane {
  public:
    using Record = R;
    static constexpr std::size_t kBytes = sizeof(R);
    static constexpr std::size_t kWords = sizeof(R) / sizeof(std::uint32_t);

    bool empty() const { return records_.empty(); }
    std::size_t size() const { return records_.size(); }
    R& operator[](std::size_t i) { return records_[i]; }
    const R& operator[](std::size_t i) const { return records_[i]; }
    const R* data() const { return records_.data(); }
    auto begin() const { return records_.begin(); }
    auto end() const { return records_.end(); }

    void reserve(std::size_t count) { records_.reserve(count); }
    /// Makes empty records, in steps, so that cancelling need not wait until a large film is zeroed.
    void make(std::size_t count) {
        while (records_.size() < count) {
            throw_if_cancelled();
            records_.resize(std::min(count, records_.size() + kStep));
        }
    }
    void clear() {
        for (std::size_t i = 0; i < size(); i += kStep) {
            throw_if_cancelled();
            std::fill_n(records_.begin() + i, std::min(kStep, size() - i), R{});
        }
    }
    /// Gives back memory that no film of this layout needs before its first sample.
    void release_spare() {}
    void merge(const Plane& more) {
        for (std::size_t i = 0; i < size(); ++i) records_[i].add(more.records_[i]);
    }

    std::size_t bytes() const { return size() * kBytes; }
    LayerState state(const FilmLayout& layout) const {
        return {std::as_bytes(std::span(records_)), std::size_t(layout.width), {}};
    }
    void set_state(const char* name, std::span<const std::byte> bytes, const FilmLayout&) {
        if (bytes.size() != size() * kBytes)
            throw input_error("film state", std::string("bytes of ") + name, std::to_string(size() * kBytes),
                              std::to_string(bytes.size()));
        std::memcpy(static_cast<void*>(records_.data()), bytes.data(), bytes.size());
        if constexpr (Settles<R>)
            for (R& record : records_) record.settle();
    }
    /// Merges words of some columns of each pixel; words of other columns are 0.
    void add_state(const char* name, std::span<const std::uint32_t> columns, std::span<const std::byte> bytes,
                   const FilmLayout& layout) {
        const std::size_t pixels = layout.pixels(), per_pixel = size() / pixels, words = per_pixel * kWords;
        const bool rises = std::ranges::adjacent_find(columns, std::ranges::greater_equal()) == columns.end();
        if (!rises || (!columns.empty() && columns.back() >= words) || bytes.size() != 4 * pixels * columns.size())
            throw input_error("film state", std::string("words of ") + name,
                              "at most " + std::to_string(words) + " columns of " + std::to_string(pixels),
                              std::to_string(columns.size()) + " with " + std::to_string(bytes.size()) + " bytes");
        std::vector<R> pixel(per_pixel);
        std::vector<std::uint32_t> all(words);
        const std::byte* next = bytes.data();
        for (std::size_t p = 0; p < pixels; ++p) {
            for (const std::uint32_t column : columns) {
                std::memcpy(&all[column], next, 4);
                next += 4;
            }
            std::memcpy(static_cast<void*>(pixel.data()), all.data(), 4 * words);
            for (std::size_t k = 0; k < per_pixel; ++k) records_[p * per_pixel + k].add(pixel[k]);
        }
    }

  private:
    static constexpr std::size_t kStep = 1 << 16;   // records
    std::vector<R> records_;
};

/// Lists of the objects of each pixel. state() makes their words by CoverLists::words().
class ObjectLists {
  public:
    static constexpr std::size_t kBytes = CoverLists::kPixelBytes + 2 * CoverLists::kEntryBytes;   // for two objects
    static constexpr std::size_t kWords = CoverLists::kEntryWords;

    bool empty() const { return !lists_; }
    CoverLists& operator*() { return *lists_; }
    const CoverLists& operator*() const { return *lists_; }

    void reserve(std::size_t) {}
    void make(std::size_t pixels) {
        pixels_ = pixels;
        if (pixels) clear();
    }
    void clear() {
        if (pixels_) lists_ = std::make_unique<CoverLists>(pixels_);
    }
    void release_spare() { clear(); }
    void merge(const ObjectLists& more) {
        if (lists_) lists_->add(*more.lists_);
    }

    std::size_t bytes() const { return 0; }   // negligible beside the planes
    LayerState state(const FilmLayout& layout) const {
        LayerState found{{}, 0, lists_->words(std::size_t(layout.width))};
        found.bytes = std::as_bytes(std::span(found.made));
        found.entries = found.made.size() / std::size_t(layout.height) / kWords;
        return found;
    }
    void set_state(const char*, std::span<const std::byte> bytes, const FilmLayout& layout) {
        read(*lists_, bytes, layout);
    }
    void add_state(const char*, std::span<const std::uint32_t>, std::span<const std::byte> bytes,
                   const FilmLayout& layout) {
        CoverLists more(pixels_);
        read(more, bytes, layout);
        lists_->add(more);
    }

  private:
    static void read(CoverLists& to, std::span<const std::byte> bytes, const FilmLayout& layout) {
        std::vector<std::uint32_t> words(bytes.size() / 4);   // a copy, as `bytes` need not be aligned
        if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
        to.set_words(words, std::size_t(layout.width));
    }

    std::size_t pixels_ = 0;
    std::unique_ptr<CoverLists> lists_;
};

}  // namespace dg
