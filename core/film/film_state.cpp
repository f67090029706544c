// film_state.cpp -- the sums of a film as the bytes that they are, and back.
#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>

#include "film/film.h"
#include "math/error.h"

namespace dg {

static_assert(std::endian::native == std::endian::little,
              "files hold the words of a sum as they lie in memory, lowest first");

std::size_t Film::pixel_bytes(const FilmLayout& l) {
    const bool lit = l.splats || l.flare;   // channels have sums of their own for that
    return kSumBytes + (l.aovs ? kAovBytes : 0) + (l.splats ? kSplatBytes : 0) + (l.flare ? kSplatBytes : 0) +
           (l.halves ? kHalfBytes : 0) + (l.coverage ? kCoverageBytes : 0) +
           (l.objects ? CoverLists::kPixelBytes + 2 * CoverLists::kEntryBytes : 0) + (l.catchers ? kCatcherBytes : 0) +
           kBandBytes * std::size_t(l.bands + l.channels * ((lit ? 2 : 1) + (l.catchers ? 2 : 0)));
}

std::vector<std::string> Film::state_parts() const {
    std::vector<std::string> parts{"sums"};
    if (layout_.aovs) parts.push_back("aovs");
    if (layout_.splats) parts.push_back("splats");
    if (layout_.flare) parts.push_back("flare");
    if (layout_.halves) parts.push_back("halves");
    if (layout_.coverage) parts.push_back("coverage");
    if (layout_.catchers) parts.push_back("catchers");
    if (layout_.bands) parts.push_back("bands");
    if (layout_.channels) parts.push_back("channels");
    if (!channel_splats_.empty()) parts.push_back("channel_splats");
    if (!catcher_channels_.empty()) parts.push_back("catcher_channels");
    return parts;
}

template <typename Self, typename Act>
void Film::with_part(Self& film, const std::string& part, const Act& act) {
    if (part == "sums") act(film.pixels_);
    if (part == "aovs") act(film.aovs_);
    if (part == "splats") act(film.splats_);
    if (part == "flare") act(film.flare_);
    if (part == "halves") act(film.halves_);
    if (part == "coverage") act(film.coverage_);
    if (part == "catchers") act(film.catchers_);
    if (part == "bands") act(film.bands_);
    if (part == "channels") act(film.channels_);
    if (part == "channel_splats") act(film.channel_splats_);
    if (part == "catcher_channels") act(film.catcher_channels_);
}

std::span<const std::byte> Film::state(const std::string& part) const {
    static_assert(sizeof(Pixel) == kSumBytes && sizeof(AovPixel) == kAovBytes &&
                  sizeof(CoveragePixel) == kCoverageBytes && sizeof(CatcherPixel) == kCatcherBytes &&
                  sizeof(Sums) == kSplatBytes && sizeof(HalfPixel) == kHalfBytes &&
                  sizeof(ValueSum) == kBandBytes);
    const std::vector<std::string> parts = state_parts();
    if (std::ranges::find(parts, part) == parts.end()) {
        std::string known;
        for (const std::string& name : parts) known += (known.empty() ? "" : " or ") + name;
        throw input_error("film state", "part", known, "'" + part + "'");
    }
    std::span<const std::byte> found;
    with_part(*this, part, [&](const auto& values) { found = std::as_bytes(std::span(values)); });
    return found;
}

std::vector<std::uint32_t> Film::object_words() const {
    return objects_ ? objects_->words(layout_.width) : std::vector<std::uint32_t>();
}

void Film::set_object_words(std::span<const std::uint32_t> words) {
    if (!objects_) throw input_error("film state", "part", "no objects", "'objects'");
    objects_->set_words(words, layout_.width);
}

void Film::set_state(const std::string& part, std::span<const std::byte> bytes) {
    const std::span<const std::byte> to = state(part);
    if (bytes.size() != to.size())
        throw input_error("film state", "bytes of " + part, std::to_string(to.size()),
                          std::to_string(bytes.size()));
    std::memcpy(const_cast<std::byte*>(to.data()), bytes.data(), to.size());   // of this very film
    // Nobody holds a lock of this film: one that a damaged file brings would never open.
    for (Pixel& pixel : pixels_) pixel.lock = 0;
}

namespace {

/// Adds to values that lie side by side in pixels, of whose words only some columns come.
template <typename T>
void add_columns(std::vector<T>& to, std::size_t pixels, std::span<const std::uint32_t> columns,
                 const std::byte* words) {
    const std::size_t each = to.size() / pixels;
    std::vector<T> pixel(each);
    std::vector<std::uint32_t> all(each * sizeof(T) / 4);
    for (std::size_t p = 0; p < pixels; ++p) {
        for (const std::uint32_t column : columns) {
            std::memcpy(&all[column], words, 4);
            words += 4;
        }
        std::memcpy(pixel.data(), all.data(), 4 * all.size());
        for (std::size_t k = 0; k < each; ++k) to[p * each + k].add(pixel[k]);
    }
}

}  // namespace

void Film::add_state(const std::string& part, std::span<const std::uint32_t> columns,
                     std::span<const std::byte> words) {
    const std::size_t pixels = pixels_.size(), each = state(part).size() / 4 / pixels;
    const bool rises = std::ranges::adjacent_find(columns, std::ranges::greater_equal()) == columns.end();
    if (!rises || (!columns.empty() && columns.back() >= each) || words.size() != 4 * pixels * columns.size())
        throw input_error("film state", "words of " + part,
                          "at most " + std::to_string(each) + " columns of " + std::to_string(pixels),
                          std::to_string(columns.size()) + " with " + std::to_string(words.size()) + " bytes");
    with_part(*this, part, [&](auto& to) { add_columns(to, pixels, columns, words.data()); });
}

void Film::add_object_words(std::span<const std::uint32_t> words) {
    if (!objects_) throw input_error("film state", "part", "no objects", "'objects'");
    CoverLists more(pixels_.size());
    more.set_words(words, layout_.width);
    objects_->add(more);
}

}  // namespace dg
