// interleave.h -- conversion between interleaved and planar channels.
#pragma once
#include <cstddef>

namespace dg {

/// Copies channel c of pixel i from[i * channels + c] to to[c * plane + i].
void split_channels(const float* from, int count, int channels, float* to,
                    std::size_t plane);

/// Copies from[c * plane + i] to to[i * channels + c].
void join_channels(const float* from, std::size_t plane, int count, int channels,
                   float* to);

}  // namespace dg
