// remap.h -- a picture seen through a map: each pixel takes its light from another place
// of the source.
//
// The filter is Keys' cubic with a = -1/2, which is exact for parabolas (Keys 1981, Cubic
// convolution interpolation for digital image processing), held between the least and the
// largest value that it reads: beside a lamp of 10000 its negative lobes would make light
// of -700. Where the map shrinks, it is stretched to the size of a pixel in the source.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "post/source_map.h"

namespace dg {

enum class RemapFilter { linear, cubic };

/// Some rows of a picture of `height` rows, values pixel by pixel.
struct RemapSource {
    std::span<const float> values;
    int width = 0, height = 0, channels = 0;
    int first = 0;  // of the rows that are there

    int rows() const { return int(values.size() / (std::size_t(width) * channels)); }
};

struct RemapResult {
    // No vector: it would write zeros first, alone, while other threads wait.
    std::unique_ptr<float[]> values;
    std::size_t size = 0;
    std::int64_t undefined = 0;  // pixels where a map is not defined; they are 0
};

/// Rows [begin, end) of the picture that the maps make. `map_of` names the map of each
/// channel. What lies outside the source is 0. Throws Error if rows of the source are
/// needed that are not there.
RemapResult remap(const RemapSource& source, std::span<const SourceMap> maps,
                  std::span<const int> map_of, int begin, int end, RemapFilter filter,
                  bool antialias);

/// The same for what cannot be mixed (depths, names of objects): the nearest pixel's
/// bits.
std::vector<std::uint32_t> remap_nearest(std::span<const std::uint32_t> values, int width,
                                         int height, int first, const SourceMap& map,
                                         int begin, int end);

}  // namespace dg
