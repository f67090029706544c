// bind_film.cpp -- exact sums per pixel.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "bind/arrays.h"
#include "bind/record.h"
#include "bind/unlocked.h"
#include "film/film.h"
#include "film/filter.h"
#include "film/kept_films.h"
#include "film/neighbours.h"
#include "film/word_columns.h"
#include "math/error.h"
#include "spectrum/wavelengths.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <typename T>
auto plane(const dg::Film& film, std::vector<T> values) {
    const auto& l = film.layout();
    return dg::bind::to_numpy(std::move(values), {std::size_t(l.height), std::size_t(l.width)});
}

template <typename T>
auto stacks(const dg::Film& film, std::vector<T> values, int each) {
    const auto& l = film.layout();
    return dg::bind::to_numpy(std::move(values),
                              {std::size_t(l.height), std::size_t(l.width), std::size_t(each)});
}

template <typename T>
auto triples(const dg::Film& film, std::vector<T> values) {
    return stacks(film, std::move(values), 3);
}

std::vector<float> to_rgb(std::vector<float> values) {
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        const dg::Rgb c = dg::rgb_from_xyz({values[i], values[i + 1], values[i + 2]});
        values[i] = c.x;
        values[i + 1] = c.y;
        values[i + 2] = c.z;
    }
    return values;
}

using Plane = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

auto next_colour(const Plane& plane, int reach) {
    return dg::bind::to_numpy(
        dg::mean_of_next_colour({plane.data(), plane.size()}, int(plane.shape(1)), reach),
        {plane.shape(0), plane.shape(1)});
}

using Curves = nb::ndarray<const double, nb::shape<-1, 401>, nb::c_contig, nb::device::cpu>;
using Words = nb::ndarray<const std::uint32_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using WordsView = nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<3>>;

/// Part of a film's state, (H, W, words), in place: it lives as long as the film does. Of lists a copy, (H, entries of the
/// longest row, words).
WordsView state(nb::handle film, const std::string& part) {
    const auto& f = nb::cast<const dg::Film&>(film);
    auto found = std::make_unique<dg::LayerState>(f.state(part));
    const std::size_t height = f.layout().height, entries = found->entries;
    const std::size_t each = found->bytes.size() / 4 / height / entries;
    const std::byte* const words = found->bytes.data();
    if (found->made.empty()) return WordsView(words, {height, entries, each}, film);
    const nb::capsule owner(found.release(), [](void* p) noexcept { delete static_cast<dg::LayerState*>(p); });
    return WordsView(words, {height, entries, each}, owner);
}

void set_state(dg::Film& film, const std::string& part, const Words& words) {
    const std::size_t rows = film.layout().height, each = film.words_of(part);
    if (words.shape(0) != rows || words.shape(2) != each)
        throw dg::input_error("film state", part, std::to_string(rows) + " rows of entries of " + std::to_string(each) + " words",
                              std::to_string(words.shape(0)) + " of " + std::to_string(words.shape(2)));
    film.set_state(part, std::as_bytes(std::span(words.data(), words.size())));
}

using FlatWords = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using FlatWordsView = nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<1>>;

FlatWordsView flat(std::vector<std::uint32_t> words) {
    auto kept = std::make_unique<std::vector<std::uint32_t>>(std::move(words));
    const std::uint32_t* const data = kept->data();
    const std::size_t size = kept->size();
    return FlatWordsView(data, {size}, nb::capsule(kept.release(), [](void* p) noexcept {
        delete static_cast<std::vector<std::uint32_t>*>(p);
    }));
}

FlatWordsView used_of(const Words& words) {
    std::vector<std::uint32_t> found;
    {
        const dg::bind::Unlocked unlocked;
        if (words.size()) found = dg::used_columns({words.data(), words.size()}, words.shape(2));
    }
    return flat(std::move(found));
}

using FlatWordsOut = nb::ndarray<std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void take_to(const Words& words, const FlatWords& columns, const FlatWordsOut& to) {
    const dg::bind::Unlocked unlocked;
    if (words.size())
        dg::take_columns({words.data(), words.size()}, words.shape(2), {columns.data(), columns.size()},
                         {to.data(), to.size()});
}

using FlatBytes = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void add_state(dg::Film& film, const std::string& part, const FlatWords& columns, const FlatBytes& words) {
    const dg::bind::Unlocked unlocked;
    film.add_state(part, {columns.data(), columns.size()}, std::as_bytes(std::span(words.data(), words.size())));
}

using Ids = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Ids and shares (H, W, ranks), pixels with more groups, and the largest share that these leave out.
auto ranked(const dg::Film& film, const Ids& ids, int ranks) {
    dg::Ranked found = film.ranked({ids.data(), ids.size()}, ranks);
    return nb::make_tuple(stacks(film, std::move(found.ids), ranks), stacks(film, std::move(found.shares), ranks),
                          found.cut_pixels, found.most_cut);
}

/// A keyword for a layer: whether to keep it, or how many values of it.
template <class Row>
void def_layer(nb::class_<dg::FilmLayout>& c, const Row& row) {
    using dg::FilmLayout;
    const dg::Layer layer = row.layer;
    if (row.most == 1)
        c.def_prop_rw(
            row.name, [layer](const FilmLayout& l) { return l.layers[layer] != 0; },
            [layer](FilmLayout& l, bool keep) { l.layers[layer] = keep; }, row.about);
    else if (row.most > 1)
        c.def_prop_rw(
            row.name, [layer](const FilmLayout& l) { return l.layers[layer]; },
            [layer](FilmLayout& l, int count) { l.layers[layer] = count; }, row.about);
}

/// Means of a layer of plain sums, (H, W, values).
auto means(const dg::Film& film, const std::string& layer) {
    std::vector<float> found = film.means(layer);
    const int each = int(found.size() / film.layout().pixels());
    return stacks(film, std::move(found), each);
}

void bind_layout(nb::module_& m) {
    using dg::FilmLayout;
    nb::class_<FilmLayout> c(m, "FilmLayout", "What a film keeps, and of which part of the frame.");
    dg::bind::def_fields_init(c, "Fields by name; nothing but the picture otherwise.");
    c.def_rw("width", &FilmLayout::width, "px, of the region that is stored.")
        .def_rw("height", &FilmLayout::height)
        .def_rw("offset_x", &FilmLayout::offset_x, "px, of that region in the full frame.")
        .def_rw("offset_y", &FilmLayout::offset_y);
    nb::dict layers;   // by name: how many a film may be asked for, and the words of a record
    dg::LayerStores<dg::kLayers>::for_each_row([&]<class Row>(const Row& row) {
        def_layer(c, row);
        if (row.most) layers[row.name] = nb::make_tuple(row.most, Row::Store::kWords);
    });
    m.attr("FILM_LAYERS") = layers;
    m.attr("FILM_AOVS") = dg::bind::names_of(dg::kAovChannels);
}

}  // namespace

void bind_film(nb::module_& m) {
    using namespace dg;
    bind_layout(m);
    nb::class_<Film>(m, "Film")
        .def(nb::init<FilmLayout>(), "layout"_a)
        .def_static("pixel_bytes", &Film::pixel_bytes, "layout"_a, "Bytes of the sums of one pixel.")
        .def("set_responses",
             [](Film& f, const Curves& curves) {
                 f.set_responses(Responses(std::span(curves.data(), curves.size())));
             },
             "curves"_a, "Sensitivity of the channels: (channels, 401) weights per nm, 380 to 780 nm.")
        .def_prop_ro("shape",
                     [](const Film& f) { return std::pair{f.layout().height, f.layout().width}; })
        .def("place", &Film::place, "offset_x"_a, "offset_y"_a, "Where its first pixel lies in the frame.")
        .def("merge", &Film::merge, "other"_a, "Adds the sums of another film, exactly.")
        .def("mean_xyz", [](const Film& f) { return triples(f, f.mean_xyz()); })
        .def("mean_rgb", [](const Film& f) { return triples(f, to_rgb(f.mean_xyz())); })
        .def("splats_rgb", [](const Film& f) { return triples(f, to_rgb(f.means("splats"))); },
             "Linear Rec.709 (H, W, 3) that light paths brought; ValueError without a layer of splats.")
        .def("flare_rgb", [](const Film& f) { return triples(f, to_rgb(f.means("flare"))); },
             "Light that ghosts added to it.")
        .def("half_rgb",
             [](const Film& f, bool odd, bool by_light_paths) {
                 return triples(f, to_rgb(f.half_xyz(odd ? Film::Half::odd : Film::Half::even, by_light_paths)));
             },
             "odd"_a, "by_light_paths"_a, "The picture of the samples with even, or odd, indices, without ghosts.")
        .def("coverage", [](const Film& f) { return plane(f, f.coverage()); },
             "Share of each pixel that objects cover, (H, W).")
        .def("ranked", &ranked, "ids"_a, "ranks"_a,
             "The same by groups of objects, each object's under its id: ids and shares (H, W, ranks), the number of "
             "pixels with more groups, and the largest share of a pixel that those leave out.")
        .def("catcher_rgb", [](const Film& f, bool with_objects) {
                 return triples(f, to_rgb(f.means("catchers", with_objects ? 0 : 3, 3)));
             },
             "with_objects"_a,
             "Light of catchers and background, linear Rec.709 (H, W, 3), with or without the objects.")
        .def("catcher_channels",
             [](const Film& f, bool with_objects) {
                 const int each = f.count_of(Layer::channels);
                 return stacks(f, f.means("catcher_channels", with_objects ? 0 : each, each), each);
             },
             "with_objects"_a, "The same in the sensor's channels, (H, W, channels).")
        .def("mean_bands", [](const Film& f) { return means(f, "bands"); },
             "Mean radiance of each band, (H, W, bands).")
        .def("mean_channels",
             [](const Film& f) { return stacks(f, f.mean_channels(), f.count_of(Layer::channels)); },
             "Mean of each of the sensor's channels, (H, W, channels).")
        .def("means", &means, "layer"_a, "Means of a layer of plain sums over the samples of the pixel, (H, W, values).")
        .def("variance_rgb", [](const Film& f) { return triples(f, f.variance_rgb()); })
        .def("relative_variance",
             [](const Film& f, float dark) { return plane(f, f.relative_variance(dark)); }, "dark"_a)
        .def("sample_counts", [](const Film& f) { return plane(f, f.sample_counts()); })
        .def("aov", [](const Film& f, const std::string& name) { return plane(f, f.aov(name)); })
        .def("object_ids", [](const Film& f) { return plane(f, f.object_ids()); })
        .def_prop_ro("bad_sample_count", &Film::bad_sample_count)
        .def_prop_ro("bad_samples",
                     [](const Film& f) {
                         std::vector<std::tuple<int, int, std::uint32_t>> out;
                         for (const BadSample& b : f.bad_samples()) out.emplace_back(b.x, b.y, b.sample);
                         return out;
                     })
        .def("state_parts", &Film::state_parts)
        .def("state", &state, "part"_a,
             "32-bit words of the sums, (H, W, words), read-only, in place. The part objects is a copy, whose rows are "
             "lists: (H, entries of the longest, 4).")
        .def("set_state", &set_state, "part"_a, "words"_a)
        .def("add_state", &add_state, "part"_a, "columns"_a, "words"_a,
             "Adds a part of the state of a film of the same layout: of its words the bytes of those of these "
             "columns, as take_columns takes them.")
        .def("clear", [](Film& f) {
            const dg::bind::Unlocked unlocked;
            f.clear();
        }, "Takes all samples away.");
    nb::class_<KeptFilms>(m, "KeptFilms", "While one lives, the next film of the same layout has the memory of the last.")
        .def(nb::init<>())
        .def_static("bytes", &KeptFilms::bytes, "Memory that waits for the next film.");
    m.def("used_columns", &used_of, "words"_a, "Columns of the last axis of (H, W, words) that are not 0 everywhere.");
    m.def("take_columns", &take_to, "words"_a, "columns"_a, "to"_a,
          "Writes the words of these columns, pixel by pixel, to a flat array.");
    m.def("mean_of_next_colour", &next_colour, "plane"_a, "reach"_a,
          "For each pixel the mean of those near it that have the next of three colours.");
}
