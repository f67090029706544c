// film.cpp -- memory of a film, and merging films.
#include "film/film.h"

#include <limits>

#include "math/error.h"

namespace dg {
namespace {

using Stores = LayerStores<kLayers>;

constexpr bool in_order() {
    std::size_t next = 0;
    bool right = true;
    Stores::for_each_row([&](const auto& row) { right = right && std::size_t(row.layer) == next++; });
    return right && next == kLayerCount;
}

constexpr std::size_t most_bytes() {
    LayerCounts all;
    Stores::for_each_row([&](const auto& row) { all[row.layer] = row.most; });
    return Stores::pixel_bytes(all);
}

static_assert(in_order(), "kLayers has a row for each Layer, at its place");
static_assert(most_bytes() < std::size_t(std::numeric_limits<std::ptrdiff_t>::max()) / kMostFilmPixels,
              "the bytes of the largest film can be counted");

std::string described(const FilmLayout& layout) {
    std::string all = std::to_string(layout.width) + " x " + std::to_string(layout.height) + " px at (" +
                      std::to_string(layout.offset_x) + ", " + std::to_string(layout.offset_y) + ")";
    Stores::for_each_row([&](const auto& row) {
        const int count = layout.layers[row.layer];
        if (count) all += std::string(", ") + (row.most > 1 ? std::to_string(count) + " " : "with ") + row.name;
    });
    return all;
}

}  // namespace

Film::Film(FilmLayout layout) : layout_(layout) {
    Stores::check(layout);
    if (std::unique_ptr<Film> kept = take_kept(layout)) {
        *this = std::move(*kept);
        clear();
        responses_ = {};
        return;
    }
    const Vec3f x = rgb_from_xyz({1, 0, 0}), y = rgb_from_xyz({0, 1, 0}), z = rgb_from_xyz({0, 0, 1});
    for (int i = 0; i < 3; ++i) rgb_from_xyz_[i] = {x[i], y[i], z[i]};
    stores_ = Stores(layout);
    if (has_emitter_layers()) row_locks_.resize(std::size_t(kLockStride) * std::size_t(layout.height));
}

void Film::set_responses(Responses responses) {
    if (responses.count() != count_of(Layer::channels))
        throw input_error("film", "responses", std::to_string(count_of(Layer::channels)) + " channels",
                          std::to_string(responses.count()));
    responses_ = std::move(responses);
}

void Film::merge(const Film& other) {
    if (!(layout_ == other.layout_)) throw input_error("film", "merge", described(layout_), described(other.layout_));
    stores_.merge(other.stores_);
}

}  // namespace dg
