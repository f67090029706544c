// film_state.cpp -- the sums of a film as bytes.
#include <bit>

#include "film/film.h"

namespace dg {

static_assert(std::endian::native == std::endian::little,
              "files hold the words of a sum as they are in memory, lowest first");

LayerState Film::state(const std::string& part) const {
    LayerState found;
    Stores::with(stores_, part, [&](const auto&, const auto& store) { found = store.state(layout_); });
    return found;
}

std::size_t Film::words_of(const std::string& part) const {
    std::size_t words = 0;
    Stores::with(stores_, part, [&](const auto& row, const auto& store) {
        words = std::size_t(row.records(layout_.layers)) * std::remove_cvref_t<decltype(store)>::kWords;
    });
    return words;
}

void Film::set_state(const std::string& part, std::span<const std::byte> bytes) {
    Stores::with(stores_, part, [&](const auto& row, auto& store) { store.set_state(row.name, bytes, layout_); });
}

void Film::add_state(const std::string& part, std::span<const std::uint32_t> columns, std::span<const std::byte> words) {
    Stores::with(stores_, part,
                 [&](const auto& row, auto& store) { store.add_state(row.name, columns, words, layout_); });
}

}  // namespace dg
