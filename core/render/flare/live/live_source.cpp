#include "render/flare/live/live_source.h"

#include <algorithm>

#include "render/flare/maps/color_table.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kNodes = LiveSource::kNodes, kSteps = LiveSource::kSteps;
constexpr float kAllAlike = 2;    // ratio of total to middle transmittance up to which both change in proportion
constexpr float kBeyond = 0.1f;   // extrapolation limit of the cubic beyond the last nodes, in steps

float sampled_nm(float u) { return Wavelengths::sample(u).nm[0]; }

/// Weights of a cubic through the four nodes around a wavelength. Reflectance of coatings rises steeply toward both
/// ends of the spectrum: constant or linear interpolation would cause errors of several percent.
struct NodeWeights {
    int first;
    std::array<float, 4> of;
    explicit NodeWeights(float nm) {
        const float place = std::clamp(LiveSource::node_of(nm), -kBeyond, kNodes - 1 + kBeyond);
        first = std::clamp(int(place) - 1, 0, kNodes - 4);
        for (int i = 0; i < 4; ++i) {
            of[i] = 1;
            for (int j = 0; j < 4; ++j)
                if (j != i) of[i] *= (place - float(first + j)) / float(i - j);
        }
    }
};

}  // namespace

LiveSource::LiveSource(SmallSource own, float free_share)
    : small(std::move(own)), colors{}, at{}, seen{}, free(free_share), light(small.luminance() * free_share) {
    Rgb mean{0, 0, 0};
    for (const SmallSource::Point& p : small.points) mean = mean + p.light * (1 / float(small.points.size()));
    for (const SmallSource::Point& p : small.points) brightness.push_back(luminance(p.light) / luminance(mean));
    const ColorTable table{Responses()};
    const auto color_of = [&](float low, float high) {   // nm
        constexpr int kParts = 8;
        FilmColor color{};
        for (int i = 0; i < kParts; ++i)
            table.add(color, mean, low + (high - low) * (float(i) + 0.5f) / kParts, (high - low) / kParts);
        return rgb_from_xyz({color[0], color[1], color[2]});
    };
    for (int i = 0; i < kSteps; ++i) {
        const float low = i == 0 ? kMinWavelength : sampled_nm(float(i) / kSteps);
        const float high = i + 1 == kSteps ? kMaxWavelength : sampled_nm(float(i + 1) / kSteps);
        at[i] = color_of(low, high) * float(kSteps);
    }
    for (float nm = kMinWavelength + 0.5f; nm < kMaxWavelength; ++nm) {
        const Rgb rgb = color_of(nm - 0.5f, nm + 0.5f);
        int group = 0;
        while (group < kGroups - 1 && nm > LiveSource::nm(float(group + 1) / kGroups)) ++group;
        const NodeWeights w(nm);
        for (int i = 0; i < 4; ++i) {
            colors[group][w.first + i] = colors[group][w.first + i] + rgb * w.of[i];
            seen[w.first + i] += luminance(rgb) * w.of[i] / luminance(mean);
        }
    }
}

float LiveSource::light_of(const std::array<float, kNodes>& spectrum) const {
    float light = 0;
    for (int k = 0; k < kNodes; ++k) light += seen[k] * spectrum[k];
    return light;
}

/// If the middle wavelength has little of the light, as with coatings that reflect only the ends of the spectrum, the
/// total changes less than the middle.
GlassChange LiveSource::change(const std::array<float, kNodes>& spectrum) const {
    static const NodeWeights middle(lambda_node(1));
    const float light = light_of(spectrum);
    float pass = 0;
    for (int i = 0; i < 4; ++i) pass += middle.of[i] * spectrum[middle.first + i];
    if (!(pass > 0 && light > 0)) return {};
    const float share = std::min(kAllAlike * pass / light, 1.f);
    return {pass, share * share / pass};
}

float LiveSource::nm(float u) {
    static const auto table = [] {
        std::array<float, kSteps> nm;
        for (int i = 0; i < kSteps; ++i) nm[i] = sampled_nm((float(i) + 0.5f) / kSteps);
        return nm;
    }();
    return table[std::size_t(u * kSteps)];
}

}  // namespace dg
