// bind_post_waves.cpp -- diffraction patterns on pixels.
#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "post/pixel_integrals.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Samples = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using First = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

dg::PixelWeights weights_of(const First& first, const Samples& weights) {
    return {{first.data(), first.size()}, {weights.data(), weights.size()}};
}

auto pixel_integrals(const Samples& samples, const First& first_row, const Samples& row_weights,
                     const First& first_column, const Samples& column_weights) {
    std::vector<float> out;
    {
        dg::bind::Unlocked unlocked;
        out = dg::pixel_integrals({samples.data(), samples.size()}, int(samples.shape(1)),
                                  weights_of(first_row, row_weights),
                                  weights_of(first_column, column_weights));
    }
    return dg::bind::to_numpy(std::move(out), {first_row.size(), first_column.size()});
}

}  // namespace

void bind_post_waves(nb::module_& m) {
    m.def("pixel_integrals", &pixel_integrals, "samples"_a, "first_row"_a, "row_weights"_a,
          "first_column"_a, "column_weights"_a,
          "Samples (h, w) integrated over pixels: weights (n, taps) of those from first (n,) on.");
}
