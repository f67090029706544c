#include "render/flare/live/live_source.h"

#include <algorithm>

#include "render/flare/maps/color_table.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kBands = LiveSource::kBands;

float band_edge(int k) { return Wavelengths::sample(std::min(float(k) / kBands, 0x1.fffffep-1f)).nm[0]; }

}  // namespace

LiveSource::LiveSource(SmallSource own, float free_share)
    : small(std::move(own)), free(free_share), light(small.luminance() * free_share) {
    Rgb mean{0, 0, 0};
    for (const SmallSource::Point& p : small.points) mean = mean + p.light * (1 / float(small.points.size()));
    for (const SmallSource::Point& p : small.points) brightness.push_back(luminance(p.light) / luminance(mean));
    const ColorTable table{Responses()};
    constexpr int kSteps = 64;
    for (int b = 0; b < kBands; ++b) {
        const float low = b == 0 ? kMinWavelength : band_edge(b), high = b + 1 == kBands ? kMaxWavelength : band_edge(b + 1);
        FilmColor sum{};
        for (int i = 0; i < kSteps; ++i)
            table.add(sum, mean, low + (high - low) * (float(i) + 0.5f) / kSteps, (high - low) * kBands / kSteps);
        colors[b] = rgb_from_xyz({sum[0], sum[1], sum[2]});
    }
}

float LiveSource::nm(float u) {
    static const auto table = [] {
        std::array<float, kBands * kFine> nm;
        for (int i = 0; i < kBands * kFine; ++i) nm[i] = Wavelengths::sample((float(i) + 0.5f) / (kBands * kFine)).nm[0];
        return nm;
    }();
    return table[std::size_t(u * kBands * kFine)];
}

const std::array<Vec2f, kBands * LiveSource::kFine>& LiveSource::lambda_weights() {
    static const auto table = [] {
        static const WavelengthScale scale = WavelengthScale::visible();
        std::array<Vec2f, kBands * kFine> weights;
        for (int i = 0; i < kBands * kFine; ++i) {
            const float l = float(scale(nm((float(i) + 0.5f) / (kBands * kFine)))) / kLambdaStep;
            weights[i] = {0.5f * l * (l - 1), 0.5f * l * (l + 1)};
        }
        return weights;
    }();
    return table;
}

}  // namespace dg
