// film_state.cpp -- a film as named channels of 32-bit words, and back.
#include <algorithm>
#include <bit>
#include <cstring>

#include "film/film.h"
#include "math/error.h"

namespace dg {
namespace {

static_assert(std::endian::native == std::endian::little,
              "words of a sum are taken from memory, lowest first");

void add_sum_names(std::vector<std::string>& names, const std::string& sum) {
    for (int word = 0; word < 4; ++word)
        names.push_back(sum + "." + std::to_string(word));
}

/// Names of the words of Film::Pixel, in order; "" is not stored.
const std::vector<std::string>& pixel_words() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> n;
        for (const char* sum :
             {"sum.X", "sum.Y", "sum.Z", "squares.R", "squares.G", "squares.B"})
            add_sum_names(n, sum);
        n.insert(n.end(), {"samples", "bad", "first_bad", ""});
        return n;
    }();
    return names;
}

/// The same for Film::AovPixel.
const std::vector<std::string>& aov_words() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> n;
        for (const std::string& aov : Film::aov_names()) add_sum_names(n, "sum." + aov);
        n.insert(n.end(), {"passed", "hits", "object_sample", "object_id"});
        return n;
    }();
    return names;
}

}  // namespace

std::vector<std::string> Film::state_channels() const {
    std::vector<std::string> names = pixel_words();
    names.pop_back();
    if (layout_.aovs) names.insert(names.end(), aov_words().begin(), aov_words().end());
    return names;
}

Film::WordPlace Film::find_word(const std::string& channel) const {
    static_assert(sizeof(Pixel) == 28 * 4 && sizeof(AovPixel) == 48 * 4);
    const auto search = [&](const std::vector<std::string>& names) -> std::ptrdiff_t {
        const auto found = std::find(names.begin(), names.end(), channel);
        return found == names.end() || channel.empty() ? -1 : found - names.begin();
    };
    const std::ptrdiff_t word = search(pixel_words());
    if (word >= 0) return {false, std::size_t(word)};
    const std::ptrdiff_t aov_word = layout_.aovs ? search(aov_words()) : -1;
    if (aov_word >= 0) return {true, std::size_t(aov_word)};
    throw input_error("film state", "channel",
                      std::string("a channel of a film ") +
                          (layout_.aovs ? "with" : "without") + " aovs",
                      "'" + channel + "'");
}

std::vector<std::uint32_t> Film::state(const std::string& channel) const {
    const WordPlace place = find_word(channel);
    std::vector<std::uint32_t> result(pixels_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const void* pixel =
            place.in_aovs ? static_cast<const void*>(&aovs_[i]) : &pixels_[i];
        std::memcpy(&result[i], static_cast<const char*>(pixel) + 4 * place.word, 4);
    }
    return result;
}

void Film::set_state(const std::string& channel,
                     const std::vector<std::uint32_t>& words) {
    const WordPlace place = find_word(channel);
    if (words.size() != pixels_.size())
        throw input_error("film state", "words of channel " + channel,
                          std::to_string(pixels_.size()), std::to_string(words.size()));
    for (std::size_t i = 0; i < words.size(); ++i) {
        void* pixel = place.in_aovs ? static_cast<void*>(&aovs_[i]) : &pixels_[i];
        std::memcpy(static_cast<char*>(pixel) + 4 * place.word, &words[i], 4);
    }
}

}  // namespace dg
