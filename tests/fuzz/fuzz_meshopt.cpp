// fuzz_meshopt.cpp -- the meshopt decoder: an Error or so many bytes, whatever comes in.
#include <cstdlib>

#include "codec/meshopt.h"
#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace dg;
    FuzzInput in(data, size);
    const int mode = in.below(3);
    // Sizes that the reader has held against the file are small; a lie may be large.
    const std::size_t count = in.flag() ? in.raw<std::uint64_t>() : in.raw<std::uint16_t>();
    const std::size_t strides[] = {4, 8, 12, 16, 64, 256};
    const std::size_t stride = mode == 0 ? strides[in.below(6)] : in.flag() ? 2 : 4;
    if (mode == 1 && count % 3) return 0;
    const Bytes packed(in.rest(), in.left());
    try {
        const auto out = mode == 0   ? unpack_attributes(packed, count, stride)
                         : mode == 1 ? unpack_triangles(packed, count, stride)
                                     : unpack_indices(packed, count, stride);
        if (out.size() != count * stride) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
