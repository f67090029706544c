// film_state.cpp -- the sums of a film as the bytes that they are, and back.
#include <bit>
#include <cstring>

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

std::span<const std::byte> Film::state(const std::string& part) const {
    static_assert(sizeof(Pixel) == kSumBytes && sizeof(AovPixel) == kAovBytes &&
                  sizeof(CoveragePixel) == kCoverageBytes && sizeof(CatcherPixel) == kCatcherBytes &&
                  sizeof(Sums) == kSplatBytes && sizeof(HalfPixel) == kHalfBytes &&
                  sizeof(ValueSum) == kBandBytes);
    if (part == "sums") return std::as_bytes(std::span(pixels_));
    if (part == "aovs" && layout_.aovs) return std::as_bytes(std::span(aovs_));
    if (part == "splats" && layout_.splats) return std::as_bytes(std::span(splats_));
    if (part == "flare" && layout_.flare) return std::as_bytes(std::span(flare_));
    if (part == "halves" && layout_.halves) return std::as_bytes(std::span(halves_));
    if (part == "coverage" && layout_.coverage) return std::as_bytes(std::span(coverage_));
    if (part == "catchers" && layout_.catchers) return std::as_bytes(std::span(catchers_));
    if (part == "bands" && layout_.bands) return std::as_bytes(std::span(bands_));
    if (part == "channels" && layout_.channels) return std::as_bytes(std::span(channels_));
    if (part == "channel_splats" && !channel_splats_.empty())
        return std::as_bytes(std::span(channel_splats_));
    if (part == "catcher_channels" && !catcher_channels_.empty())
        return std::as_bytes(std::span(catcher_channels_));
    std::string known;
    for (const std::string& name : state_parts()) known += (known.empty() ? "" : " or ") + name;
    throw input_error("film state", "part", known, "'" + part + "'");
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

}  // namespace dg
