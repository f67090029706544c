// arrays.h -- conversion of numpy arrays. The core reads arrays in place and keeps them alive; callers guarantee that
// they are not modified (build.py).
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <vector>

#include "math/shared_array.h"
#include "math/transform.h"

namespace dg::bind {

namespace nb = nanobind;

using Rows2f = nb::ndarray<const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Rows3f = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Steps3f = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using Steps4f = nb::ndarray<const float, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>;
using Rows4f = nb::ndarray<const float, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using Rows3u = nb::ndarray<const std::uint32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using RowF = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using RowU = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix4 = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;

/// View of a C-contiguous array as elements of type T (void: the array's type), without a copy. The array is released
/// with the last view, on any thread: nanobind takes the interpreter's lock for that.
template <typename T = void, typename Array>
auto shared(const Array& array) {
    using Own = std::remove_const_t<typename Array::Scalar>;
    using Element = std::conditional_t<std::is_void_v<T>, Own, T>;
    static_assert(std::is_trivially_copyable_v<Element>);
    return SharedArray<Element>(reinterpret_cast<const Element*>(array.data()),
                                array.nbytes() / sizeof(Element),
                                std::make_shared<const Array>(array));
}

/// 16 numbers, row by row.
inline Affine3d to_affine(const double* p) {
    return {{p[0], p[4], p[8]}, {p[1], p[5], p[9]}, {p[2], p[6], p[10]}, {p[3], p[7], p[11]}};
}

inline Affine3d to_affine(const Matrix4& m) { return to_affine(m.data()); }

/// A numpy array that owns a vector; the product of `shape` must be its size.
template <typename T>
nb::ndarray<nb::numpy, T> to_numpy(std::vector<T> values, std::initializer_list<std::size_t> shape) {
    auto* owned = new std::vector<T>(std::move(values));
    nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::ndarray<nb::numpy, T>(owned->data(), shape, owner);
}

/// The names of a list of channels, as a tuple.
template <typename Channels>
nb::tuple names_of(const Channels& channels) {
    nb::list names;
    for (const auto& channel : channels) names.append(channel.name);
    return nb::tuple(names);
}

}  // namespace dg::bind
