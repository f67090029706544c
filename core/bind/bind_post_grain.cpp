// bind_post_grain.cpp -- film grain.
#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "post/grain.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

auto grain_pattern(int x0, int y0, int width, int height, double radius, std::uint64_t seed, int layer) {
    std::vector<float> out;
    {
        dg::bind::Unlocked release;
        out = dg::grain_pattern({x0, y0, width, height}, radius, seed, layer);
    }
    return dg::bind::to_numpy(std::move(out), {std::size_t(height), std::size_t(width)});
}

}  // namespace

void bind_post_grain(nb::module_& m) {
    m.def("grain_pattern", &grain_pattern, "x0"_a, "y0"_a, "width"_a, "height"_a, "radius"_a, "seed"_a,
          "layer"_a, "Normal numbers (height, width) by place alone, as round grains of a radius in px have.");
}
