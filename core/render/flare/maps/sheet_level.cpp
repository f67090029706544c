#include "render/flare/maps/sheet_level.h"

#include <algorithm>
#include <cmath>

#include "render/flare/maps/coarse_light.h"

namespace dg {
namespace {

constexpr double kSharpest = 0.1;              // share of the light that is ignored
constexpr float kPitches = 5, kEvenPitches = 8;   // node spacings per blur, and per e-fold change of light
constexpr float kBend = 0.02f, kSlope = 0.3f;     // second and first derivative of the variance over the distance
constexpr float kVariance = CoarseLight::variance(0), kCoarsest = CoarseLight::variance(SheetLevel::kMost);

/// Variance (px2) at a distance from an edge.
float variance_at(float px) {
    if (!(px > 0)) return 0;
    constexpr float kStraight = kSlope / kBend;
    return px < kStraight ? 0.5f * kBend * px * px : kSlope * (px - 0.5f * kStraight);
}

float level_of(float variance) { return CoarseLight::level_of(variance, 0, SheetLevel::kMost); }

float without_sharpest(std::vector<SheetSmooth::CellLight>& cells, double sharpest, float CellBlur::*value) {
    std::ranges::sort(cells, {}, [&](const SheetSmooth::CellLight& c) { return c.blur->*value; });
    double sum = 0;
    for (const auto& c : cells)
        if ((sum += c.light) >= sharpest) return c.blur->*value;
    return 0;
}

}  // namespace

SheetSmooth SheetSmooth::of(std::vector<CellLight> cells) {
    double sum = 0;
    for (const CellLight& c : cells) sum += c.light;
    return {without_sharpest(cells, kSharpest * sum, &CellBlur::edge),
            without_sharpest(cells, kSharpest * sum, &CellBlur::even_px)};
}

SheetLevel::SheetLevel(int crossings, const GhostLens& lens, const Sensor& sensor, float filled,
                       const SheetSmooth& smooth)
    : crossings_(crossings), smooth_(smooth), filled_(filled), apothem_(float(lens.iris_radius() * lens.iris().inner_radius())),
      most_(std::min(kCoarsest, CoarseLight::widest(sensor))) {}

float SheetLevel::pitch(const CellBlur& blur) const { return 2 * blur.edge * filled_ / kPitches; }

float SheetLevel::of_rays() const {
    const float pitch = smooth_.edge * filled_ / kPitches;
    return std::max(level_of(kVariance * pitch * pitch), 1.f);
}

/// Distance from the nearest edge, px; negative in the shadow.
float SheetLevel::from_edge(const CellBlur& blur, const MapBatch& b, int i) const {
    float far = blur.beyond_per_px > 0 ? -b.beyond[i] / blur.beyond_per_px : 1e9f;
    for (int k = 0; k < crossings_; ++k) {
        const float r = std::sqrt(b.iris_x[k][i] * b.iris_x[k][i] + b.iris_y[k][i] * b.iris_y[k][i]);
        far = std::min(far, (apothem_ * b.opening[i] - r) * blur.px_per_mm[std::size_t(k)]);
    }
    return far;
}

/// Combines the blur with the distance from an edge and the gradient of the light: far from edges even a sharp ghost is
/// smooth. The transition is smooth.
float SheetLevel::of(const CellBlur& blur, const MapBatch& batch, int i) const {
    const auto squared = [](float x) { return x * x; };
    const float edge = std::min(blur.edge, smooth_.edge), even = std::min(blur.even_px, smooth_.even);
    const float blurred = kVariance * squared(2 * edge * filled_ / kPitches);
    const float most = std::min(kVariance * squared(even / kEvenPitches), most_) - blurred;
    const float far = variance_at(from_edge(blur, batch, i));
    return level_of(blurred + (most > 0 ? far * most / (far + most) : 0));
}

}  // namespace dg
