// film_state.cpp -- the sums of a film as the bytes that they are, and back.
#include <bit>
#include <cstring>

#include "film/film.h"
#include "math/error.h"

namespace dg {

static_assert(std::endian::native == std::endian::little,
              "files hold the words of a sum as they lie in memory, lowest first");

std::vector<std::string> Film::state_parts() const {
    if (layout_.aovs) return {"sums", "aovs"};
    return {"sums"};
}

std::span<const std::byte> Film::state(const std::string& part) const {
    static_assert(sizeof(Pixel) == kSumBytes && sizeof(AovPixel) == kAovBytes);
    if (part == "sums") return std::as_bytes(std::span(pixels_));
    if (part == "aovs" && layout_.aovs) return std::as_bytes(std::span(aovs_));
    throw input_error("film state", "part", layout_.aovs ? "sums or aovs" : "sums",
                      "'" + part + "'");
}

void Film::set_state(const std::string& part, std::span<const std::byte> bytes) {
    const std::size_t wanted = state(part).size();
    if (bytes.size() != wanted)
        throw input_error("film state", "bytes of " + part, std::to_string(wanted),
                          std::to_string(bytes.size()));
    void* to = part == "sums" ? static_cast<void*>(pixels_.data()) : aovs_.data();
    std::memcpy(to, bytes.data(), wanted);
    // Nobody holds a lock of this film: one that a damaged file brings would never open.
    for (Pixel& pixel : pixels_) pixel.lock = 0;
}

}  // namespace dg
