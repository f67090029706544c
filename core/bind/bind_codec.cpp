// bind_codec.cpp -- bindings of decoders.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <bit>

#include "bind/arrays.h"
#include "bind/choose.h"
#include "bind/unlocked.h"
#include "codec/exr_predictor.h"
#include "codec/list_rows.h"
#include "codec/meshopt.h"
#include "codec/text_numbers.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace dg::bind {
namespace {

using PackedBytes =
    nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Lengths =
    nb::ndarray<const std::uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
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

/// Type of the length field of a list ("<u1"; empty: none), and bytes per number.
using Field = std::pair<std::string, std::size_t>;

std::vector<RowField> to_fields(const std::vector<Field>& fields) {
    const char other = std::endian::native == std::endian::little ? '>' : '<';
    std::vector<RowField> out;
    for (const auto& [type, size] : fields) {
        using enum LengthType;
        const std::string code = type.empty() ? type : type.substr(1);
        const LengthType length = choose<LengthType>(
            "length", code,
            {{"", none}, {"i1", i1}, {"u1", u1}, {"i2", i2}, {"u2", u2}, {"i4", i4},
             {"u4", u4}, {"i8", i8}, {"u8", u8}, {"f8", f8}},
            "rows");
        out.push_back({size, length, !type.empty() && type[0] == other});
    }
    return out;
}

auto list_lengths(const PackedBytes& data, std::size_t begin, std::size_t count,
                  const std::vector<Field>& fields) {
    const std::vector<RowField> own = to_fields(fields);
    ListLengths found;
    {
        const Unlocked unlocked;
        found = dg::list_lengths({data.data(), data.size()}, begin, count, own);
    }
    const auto lists = std::size_t(std::ranges::count_if(
        own, [](const RowField& one) { return one.length != LengthType::none; }));
    return nb::make_tuple(to_numpy(std::move(found.lengths), {found.rows, lists}),
                          found.end);
}

void copy_field(const PackedBytes& data, std::size_t begin,
                const std::vector<Field>& fields, const Lengths& lengths,
                std::size_t field, const WritableBytes& out) {
    const std::vector<RowField> own = to_fields(fields);
    const Unlocked unlocked;
    dg::copy_field({data.data(), data.size()}, begin, own,
                   {lengths.data(), lengths.size()}, field, {out.data(), out.size()});
}

template <typename T>
auto text_numbers(const PackedBytes& text, TextNumbers<T> (*read)(Bytes)) {
    TextNumbers<T> found;
    {
        const Unlocked unlocked;
        found = read({text.data(), text.size()});
    }
    const std::size_t size = found.values.size();
    return nb::make_tuple(to_numpy(std::move(found.values), {size}), found.end);
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
    m.def("list_lengths", &dg::bind::list_lengths, "data"_a, "begin"_a, "count"_a,
          "fields"_a,
          "Lengths of the lists of rows, shape (R, L), R fewer than count where the data "
          "end before, and where they end.\n\nA field is the type of the length of a list "
          "('<u1'; empty: none), and bytes of a number.");
    m.def("copy_field", &dg::bind::copy_field, "data"_a, "begin"_a, "fields"_a,
          "lengths"_a, "field"_a, "out"_a,
          "Copies a field of all rows that list_lengths found.");
    m.def(
        "text_floats",
        [](const dg::bind::PackedBytes& text) {
            return dg::bind::text_numbers(text, dg::text_floats);
        },
        "text"_a,
        "Numbers of a text, shape (N,), up to the first word that is none, and where that "
        "begins.");
    m.def(
        "text_integers",
        [](const dg::bind::PackedBytes& text) {
            return dg::bind::text_numbers(text, dg::text_integers);
        },
        "text"_a, "The same of whole numbers.");
}
