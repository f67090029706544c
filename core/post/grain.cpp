#include "post/grain.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "math/error.h"
#include "math/hash.h"
#include "post/iris_kernel.h"

namespace dg {
namespace {

constexpr int kCorners = 64;   // of a grain's outline
constexpr int kMostSide = 1 << 20;

struct Tap {
    int dx, dy;
    float weight;
};

IrisShape round_grain() {
    std::vector<Vec2d> corners;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * kPiD * i / kCorners;
        corners.push_back({std::cos(angle), std::sin(angle)});
    }
    return IrisShape::outline(corners);
}

/// Coverage of pixels by a grain, scaled so that squares sum to 1.
std::vector<Tap> grain_taps(double radius) {
    const IrisKernel kernel = iris_kernel(round_grain(), radius);
    std::vector<Tap> taps;
    double squares = 0;
    for (int dy = kernel.top; dy <= kernel.bottom; ++dy) {
        double sum = 0;
        int s = kernel.begin(dy);
        for (int dx = kernel.left; dx <= kernel.right; ++dx) {
            while (s < kernel.begin(dy + 1) && kernel.steps[s].dx <= dx) sum += kernel.steps[s++].change;
            taps.push_back({dx, dy, float(sum)});
            squares += sum * sum;
        }
    }
    for (Tap& tap : taps) tap.weight *= float(1 / std::sqrt(squares));
    return taps;
}

/// Normal number from 64 random bits. Source: Box and Muller 1958.
float normal_of(std::uint64_t bits) {
    const double u = (double(bits >> 32) + 0.5) * 0x1p-32, v = double(bits & 0xffffffffu) * 0x1p-32;
    return float(std::sqrt(-2 * std::log(u)) * std::cos(2 * kPiD * v));
}

}  // namespace

std::vector<float> grain_pattern(const GrainWindow& window, double radius, std::uint64_t seed, int layer) {
    if (!(radius > 0 && radius <= 256))
        throw input_error("grain", "radius", "more than 0 and up to 256 px", std::to_string(radius));
    for (const int side : {window.width, window.height})
        if (side < 0 || side > kMostSide)
            throw input_error("grain", "size", "0 to " + std::to_string(kMostSide) + " px", std::to_string(side));
    const std::vector<Tap> taps = grain_taps(radius);
    const int reach = int(std::ceil(radius * 1.01 + 0.5));
    const int width = window.width + 2 * reach, height = window.height + 2 * reach;
    std::vector<float> white(std::size_t(width) * height);
    oneapi::tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::uint32_t at_x = window.x0 - reach + x, at_y = window.y0 - reach + y;
            white[std::size_t(y) * width + x] = normal_of(hash64(seed, layer, at_x, at_y));
        }
    });
    std::vector<float> out(std::size_t(window.width) * window.height);
    oneapi::tbb::parallel_for(0, window.height, [&](int y) {
        float* const row = out.data() + std::size_t(y) * window.width;
        for (const Tap& tap : taps) {
            const float* const from = white.data() + std::size_t(y + reach + tap.dy) * width + reach + tap.dx;
            for (int x = 0; x < window.width; ++x) row[x] += tap.weight * from[x];
        }
    });
    return out;
}

}  // namespace dg
