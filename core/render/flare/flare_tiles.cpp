#include "render/flare/flare_tiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dg {
namespace {

constexpr int kAcross = 64;           // tiles along the longer side
constexpr double kDarkShare = 0.1;    // fraction of the mean that limits relative errors

}  // namespace

FlareTiles::FlareTiles(const Sensor& sensor) {
    per_px_ = std::min(1.f, float(kAcross) / float(std::max(sensor.width, sensor.height)));
    columns_ = std::max(1, int(std::ceil(float(sensor.width) * per_px_)));
    rows_ = std::max(1, int(std::ceil(float(sensor.height) * per_px_)));
    light_.resize(std::size_t(columns_) * rows_);
}

std::size_t FlareTiles::index(Vec2f px) const {
    const int x = std::clamp(int(px.x * per_px_), 0, columns_ - 1);
    const int y = std::clamp(int(px.y * per_px_), 0, rows_ - 1);
    return std::size_t(y) * columns_ + x;
}

void FlareTiles::add(Vec2f px, double light) {
    light_[index(px)] += light;
}

void FlareTiles::finish() {
    const double mean = mean_ = std::accumulate(light_.begin(), light_.end(), 0.0) / double(light_.size());
    const double dark = kDarkShare * kDarkShare * mean * mean;
    importance_.assign(light_.size(), 1);
    if (!(mean > 0)) return;
    for (int y = 0; y < rows_; ++y)
        for (int x = 0; x < columns_; ++x) {
            double sum = 0, weights = 0;
            for (int k = 0; k < 9; ++k) {
                const int dx = k % 3 - 1, dy = k / 3 - 1;
                if (x + dx < 0 || x + dx >= columns_ || y + dy < 0 || y + dy >= rows_) continue;
                const double weight = (2 - std::abs(dx)) * (2 - std::abs(dy));
                sum += weight * light_[std::size_t(y + dy) * columns_ + x + dx], weights += weight;
            }
            const double r = sum / weights;
            importance_[std::size_t(y) * columns_ + x] = float(mean / std::sqrt(r * r + dark));
        }
}

}  // namespace dg
