// layer_stores.h -- memory of the layers of a film, by the rows of a table such as kLayers.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "film/layers.h"
#include "math/error.h"

namespace dg {

inline constexpr std::int64_t kMostFilmPixels = std::int64_t(1) << 31;

template <const auto& kRows>
class LayerStores {
    static constexpr auto kAll = std::make_index_sequence<std::tuple_size_v<std::remove_cvref_t<decltype(kRows)>>>();

  public:
    /// Calls act(row) for each row.
    template <class Act>
    static constexpr void for_each_row(const Act& act) {
        std::apply([&](const auto&... row) { (act(row), ...); }, kRows);
    }
    /// Bytes of a pixel (Film::pixel_bytes).
    static constexpr std::size_t pixel_bytes(const LayerCounts& asked) {
        std::size_t bytes = 0;
        for_each_row([&](const auto& row) {
            bytes += std::remove_cvref_t<decltype(row)>::Store::kBytes * std::size_t(row.records(asked));
        });
        return bytes;
    }
    /// Throws Error for an invalid layout; allocates nothing.
    static void check(const FilmLayout& layout);

    LayerStores() = default;
    /// Makes the empty layers of a checked layout. All memory is reserved before any is written.
    explicit LayerStores(const FilmLayout& layout) {
        const auto records = [&](const auto& row) { return layout.pixels() * std::size_t(row.records(layout.layers)); };
        for_each([&](const auto& row, auto& store) { store.reserve(records(row)); });
        for_each([&](const auto& row, auto& store) { store.make(records(row)); });
    }

    template <Layer kLayer>
    auto& of() { return std::get<std::size_t(kLayer)>(stores_); }
    template <Layer kLayer>
    const auto& of() const { return std::get<std::size_t(kLayer)>(stores_); }
    /// Calls act(row, store) for each row.
    template <class Act>
    void for_each(const Act& act) { visit(*this, act, kAll); }
    template <class Act>
    void for_each(const Act& act) const { visit(*this, act, kAll); }
    /// Calls act(row, store) for the layer of this name. Throws Error if the film does not keep it.
    template <class Self, class Act>
    static void with(Self& self, const std::string& name, const Act& act);

    std::vector<std::string> names() const;
    void merge(const LayerStores& more) { merge(more, kAll); }

  private:
    template <class Row>
    using StoreOf = typename Row::Store;
    template <class T>
    struct Stores;
    template <class... Rows>
    struct Stores<std::tuple<Rows...>> {
        using All = std::tuple<StoreOf<Rows>...>;
    };
    template <class Self, class Act, std::size_t... k>
    static void visit(Self& self, const Act& act, std::index_sequence<k...>) {
        (act(std::get<k>(kRows), std::get<k>(self.stores_)), ...);
    }
    template <std::size_t... k>
    void merge(const LayerStores& more, std::index_sequence<k...>) {
        (std::get<k>(stores_).merge(std::get<k>(more.stores_)), ...);
    }

    typename Stores<std::remove_cvref_t<decltype(kRows)>>::All stores_;
};

template <const auto& kRows>
void LayerStores<kRows>::check(const FilmLayout& layout) {
    const std::int64_t pixels = std::int64_t(layout.width) * layout.height;
    if (layout.width < 1 || layout.height < 1 || pixels > kMostFilmPixels)
        throw input_error("film", "size in px", "at least 1 x 1 and at most 2^31 pixels",
                          std::to_string(layout.width) + " x " + std::to_string(layout.height));
    for_each_row([&](const auto& row) {
        const int asked = layout.layers[row.layer];
        if (asked < 0 || asked > row.most)
            throw input_error("film", row.name, "0 to " + std::to_string(row.most), std::to_string(asked));
        if (!asked || row.needs == Layer::sums || layout.layers[row.needs]) return;
        for_each_row([&](const auto& other) {
            if (other.layer == row.needs) throw input_error("film", row.name, other.name, "none");
        });
    });
}

template <const auto& kRows>
template <class Self, class Act>
void LayerStores<kRows>::with(Self& self, const std::string& name, const Act& act) {
    bool found = false;
    self.for_each([&](const auto& row, auto& store) {
        if (name != row.name || store.empty()) return;
        found = true;
        act(row, store);
    });
    if (found) return;
    std::string known;
    for (const std::string& each : self.names()) known += (known.empty() ? "" : " or ") + each;
    throw input_error("film", "layer", known, "'" + name + "'");
}

template <const auto& kRows>
std::vector<std::string> LayerStores<kRows>::names() const {
    std::vector<std::string> found;
    for_each([&](const auto& row, const auto& store) {
        if (!store.empty()) found.emplace_back(row.name);
    });
    return found;
}

}  // namespace dg
