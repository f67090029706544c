// remap.h -- resampling of an image through a map: each pixel reads another position of the source.
//
// The filter is Keys' cubic with a = -1/2, exact for parabolas (Keys 1981, Cubic convolution
// interpolation for digital image processing), clamped to the range of the values that it reads:
// next to a lamp of 10000 its negative lobes would produce light of -700. Where the map minifies,
// the filter is stretched to the size of a pixel in the source.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "post/source_map.h"

namespace dg {

enum class RemapFilter { linear, cubic };

/// Rows of an image of `height` rows, interleaved.
struct RemapSource {
    std::span<const float> values;
    int width = 0, height = 0, channels = 0;
    int first = 0;  // index of the first available row

    int rows() const { return int(values.size() / (std::size_t(width) * channels)); }
};

struct RemapResult {
    // Not a vector, which would zero the memory in a single thread.
    std::unique_ptr<float[]> values;
    std::size_t size = 0;
    std::int64_t undefined = 0;  // pixels with an undefined map; they are 0
};

/// Remaps rows [begin, end) of the result. `map_of` selects the map of each channel. Pixels outside
/// of the source are 0. Throws Error if required rows of the source are missing.
RemapResult remap(const RemapSource& source, std::span<const SourceMap> maps,
                  std::span<const int> map_of, int begin, int end, RemapFilter filter,
                  bool antialias);

/// Nearest-neighbour remap for data that must not be mixed (depths, object names); copies bits.
std::vector<std::uint32_t> remap_nearest(std::span<const std::uint32_t> values, int width,
                                         int height, int first, const SourceMap& map,
                                         int begin, int end);

}  // namespace dg
