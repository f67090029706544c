// bind_develop_picture.cpp -- conversion of sensor channels to pictures.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bind/arrays.h"
#include "bind/record.h"
#include "bind/unlocked.h"
#include "develop/picture.h"
#include "develop/sharpen.h"
#include "math/error.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Numbers = std::array<float, 3>;
using Values = std::optional<std::vector<float>>;
template <typename T>
using Pixels = nb::ndarray<T, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

dg::Vec3f vec(const Numbers& v) { return {v[0], v[1], v[2]}; }

std::optional<dg::Curve> curve(Values values) {
    if (!values) return std::nullopt;
    return dg::Curve(std::move(*values));
}

template <typename T>
void develop(const Pixels<const T>& in, const Pixels<float>& out, const dg::Development& how) {
    dg::bind::Unlocked unlocked;
    dg::develop(how, std::span(in.data(), in.size()), std::span(out.data(), out.size()));
}

void sharpen(const Pixels<float>& rgb, const Numbers& luminance, float amount, float radius) {
    const float weights[3] = {luminance[0], luminance[1], luminance[2]};
    dg::bind::Unlocked unlocked;
    dg::sharpen(std::span(rgb.data(), rgb.size()), int(rgb.shape(1)), int(rgb.shape(0)), weights, amount, radius);
}

template <typename T>
void def_develop(nb::module_& m) {
    m.def("develop_picture", &develop<T>, "pixels"_a.noconvert(), "out"_a.noconvert(), "how"_a,
          "Channels (H, W, 3) into the numbers of a picture, written to `out`.");
}

/// A field of three channels.
void def_numbers(nb::class_<dg::Development>& c, const char* name, dg::Vec3f dg::Development::* member,
                 const char* doc) {
    c.def_prop_rw(
        name, [member](const dg::Development& d) { const dg::Vec3f v = d.*member; return Numbers{v.x, v.y, v.z}; },
        [member](dg::Development& d, const Numbers& v) { d.*member = vec(v); }, doc);
}

void bind_development(nb::module_& m) {
    using dg::Development;
    nb::class_<Development> c(m, "Development", "From linear channels to the numbers of a picture.");
    dg::bind::def_fields_init(c, "Fields by name.");
    def_numbers(c, "balance", &Development::balance, "Factor of each channel: the neutral has three equal numbers.");
    def_numbers(c, "full", &Development::full, "Where channels are full, before balance.");
    def_numbers(c, "luminance", &Development::luminance, "Weights of linear R, G, B.");
    c.def_rw("rgb_from_balanced", &Development::rgb_from_balanced, "Matrix, linear, row by row.")
        .def_prop_rw(
            "highlights", [](const Development& d) { return int(d.highlights); },
            [](Development& d, std::string_view name) { d.highlights = dg::highlights_of(name); })
        .def_prop_rw(
            "tone", [](const Development& d) { return d.tone.has_value(); },
            [](Development& d, Values values) { d.tone = curve(std::move(values)); },
            nb::for_setter(nb::arg("values").none()),
            "Scene to display, both linear: values at curve_breakpoints(); None: as it is up to 1.")
        .def_prop_rw(
            "encode", [](const Development& d) { return d.encode.has_value(); },
            [](Development& d, Values values) { d.encode = curve(std::move(values)); },
            nb::for_setter(nb::arg("values").none()),
            "Display to numbers of the file: values at curve_breakpoints(); None: scene-linear.");
}

}  // namespace

void bind_develop_picture(nb::module_& m) {
    bind_development(m);
    def_develop<std::uint16_t>(m);
    def_develop<float>(m);
    m.def("curve_breakpoints", &dg::Curve::breakpoints, "Where a curve of light has to be known.");
    m.def("sharpen", &sharpen, "rgb"_a.noconvert(), "luminance"_a, "amount"_a, "radius"_a,
          "An unsharp mask of the brightness of (H, W, 3), in place; radius in px.");
}
