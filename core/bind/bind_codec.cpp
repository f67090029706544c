// bind_codec.cpp -- packed bytes to bytes.
#include <nanobind/stl/string_view.h>

#include "bind/arrays.h"
#include "bind/unlocked.h"
#include "codec/exr_predictor.h"
#include "codec/meshopt.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace dg::bind {
namespace {

using PackedBytes =
    nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using WritableBytes = nb::ndarray<std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

auto unpack_meshopt(const PackedBytes& packed, std::string_view mode, std::size_t count,
                    std::size_t stride) {
    const Bytes bytes(packed.data(), packed.size());
    std::vector<std::uint8_t> out;
    {
        dg::bind::Unlocked unlocked;
        out = mode == "ATTRIBUTES"  ? unpack_attributes(bytes, count, stride)
              : mode == "TRIANGLES" ? unpack_triangles(bytes, count, stride)
                                    : unpack_indices(bytes, count, stride);
    }
    const std::size_t size = out.size();
    return to_numpy(std::move(out), {size});
}

void undo_exr_predictor(const PackedBytes& packed, const WritableBytes& pixels) {
    const Unlocked unlocked;
    dg::undo_exr_predictor({packed.data(), packed.size()}, {pixels.data(), pixels.size()});
}

}  // namespace
}  // namespace dg::bind

void bind_codec(nb::module_& m) {
    m.def("unpack_meshopt", &dg::bind::unpack_meshopt, "packed"_a, "mode"_a, "count"_a,
          "stride"_a,
          "Bytes of a meshopt stream of mode ATTRIBUTES, TRIANGLES or INDICES, shape "
          "(count * stride,).");
    m.def("undo_exr_predictor", &dg::bind::undo_exr_predictor, "packed"_a, "pixels"_a,
          "Inflated bytes of an OpenEXR block as its pixels, into an array of as many bytes.");
}
