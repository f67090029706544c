// meshopt.h -- decoders of the three bitstreams of EXT_meshopt_compression and
// KHR_meshopt_compression, written from the bitstream specification in the README of
// KHR_meshopt_compression (appendix A; version 0 is the EXT format). Malformed streams throw Error.
// The size of a stream is checked against the claimed number of elements before any allocation.
#pragma once
#include <vector>

#include "codec/bytes.h"

namespace dg {

/// Mode ATTRIBUTES: `count` elements of `stride` bytes (4 .. 256, a multiple of 4), versions 0 and
/// 1.
std::vector<std::uint8_t> unpack_attributes(Bytes packed, std::size_t count,
                                            std::size_t stride);

/// Mode TRIANGLES: `count` indices (a multiple of 3) of `stride` bytes (2 or 4), little-endian.
std::vector<std::uint8_t> unpack_triangles(Bytes packed, std::size_t count,
                                           std::size_t stride);

/// Mode INDICES: `count` indices of `stride` bytes (2 or 4), little-endian.
std::vector<std::uint8_t> unpack_indices(Bytes packed, std::size_t count,
                                         std::size_t stride);

}  // namespace dg
