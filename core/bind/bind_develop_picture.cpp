// bind_develop_picture.cpp -- channels into pictures.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bind/arrays.h"
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
void develop(const Pixels<const T>& in, const Pixels<float>& out, const Numbers& balance, const Numbers& full,
             std::string_view highlights, const std::array<float, 9>& matrix, const Numbers& luminance,
             Values tone, Values encode) {
    const dg::Development how{vec(balance), vec(full), dg::highlights_of(highlights), matrix, vec(luminance),
                              curve(std::move(tone)), curve(std::move(encode))};
    nb::gil_scoped_release unlocked;
    dg::develop(how, std::span(in.data(), in.size()), std::span(out.data(), out.size()));
}

void sharpen(const Pixels<float>& rgb, const Numbers& luminance, float amount, float radius) {
    const float weights[3] = {luminance[0], luminance[1], luminance[2]};
    nb::gil_scoped_release unlocked;
    dg::sharpen(std::span(rgb.data(), rgb.size()), int(rgb.shape(1)), int(rgb.shape(0)), weights, amount, radius);
}

template <typename T>
void def_develop(nb::module_& m) {
    m.def("develop_picture", &develop<T>, "pixels"_a.noconvert(), "out"_a.noconvert(), "balance"_a, "full"_a,
          "highlights"_a, "rgb_from_balanced"_a, "luminance"_a, "tone"_a = nb::none(), "encode"_a = nb::none(),
          "Channels (H, W, 3) into the numbers of a picture, written to `out`; curves by their values at "
          "curve_breakpoints().");
}

}  // namespace

void bind_develop_picture(nb::module_& m) {
    def_develop<std::uint16_t>(m);
    def_develop<float>(m);
    m.def("curve_breakpoints", &dg::Curve::breakpoints, "Where a curve of light has to be known.");
    m.def("sharpen", &sharpen, "rgb"_a.noconvert(), "luminance"_a, "amount"_a, "radius"_a,
          "An unsharp mask of the brightness of (H, W, 3), in place; radius in px.");
}
