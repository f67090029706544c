#include "develop/sharpen.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/error.h"

namespace dg {
namespace {

/// Weights of a Gaussian at whole px, from the centre outward; normalized to a sum of 1 over both
/// sides.
std::vector<float> gaussian(float radius) {
    std::vector<float> taps;
    double sum = 0;
    for (int i = 0; i <= std::ceil(3 * radius); ++i) {
        taps.push_back(std::exp(-0.5f * i * i / (radius * radius)));
        sum += (i ? 2 : 1) * double(taps.back());
    }
    for (float& tap : taps) tap = float(tap / sum);
    return taps;
}

}  // namespace

void sharpen(std::span<float> rgb, int width, int height, const float (&luminance)[3], float amount,
             float radius) {
    if (rgb.size() != std::size_t(3) * width * height)
        throw input_error("sharpen", "picture", "width x height x 3 numbers", std::to_string(rgb.size()));
    if (!(radius >= 0.1f && radius <= 50))
        throw input_error("sharpen", "radius", "0.1 to 50 px", std::to_string(radius));
    const std::vector<float> taps = gaussian(radius);
    const int reach = int(taps.size()) - 1;
    std::vector<float> light(std::size_t(width) * height), across(light.size());
    oneapi::tbb::parallel_for(0, height, [&](int y) {
        float* const row = light.data() + std::size_t(y) * width;
        for (int x = 0; x < width; ++x) {
            const float* const p = rgb.data() + 3 * (std::size_t(y) * width + x);
            row[x] = luminance[0] * p[0] + luminance[1] * p[1] + luminance[2] * p[2];
        }
        float* const to = across.data() + std::size_t(y) * width;
        for (int x = 0; x < width; ++x) {
            float sum = taps[0] * row[x];
            for (int i = 1; i <= reach; ++i)
                sum += taps[i] * (row[std::max(x - i, 0)] + row[std::min(x + i, width - 1)]);
            to[x] = sum;
        }
    });
    oneapi::tbb::parallel_for(0, height, [&](int y) {
        std::vector<float> soft(width, 0.0f);
        for (int i = -reach; i <= reach; ++i) {
            const float* const from = across.data() + std::size_t(std::clamp(y + i, 0, height - 1)) * width;
            for (int x = 0; x < width; ++x) soft[x] += taps[std::abs(i)] * from[x];
        }
        for (int x = 0; x < width; ++x) {
            const std::size_t at = std::size_t(y) * width + x;
            const float more = amount * (light[at] - soft[x]);
            for (int k = 0; k < 3; ++k) rgb[3 * at + k] += more;
        }
    });
}

}  // namespace dg
