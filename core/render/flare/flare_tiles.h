// flare_tiles.h -- coarse brightness of the flare over the frame, as the reference for relative errors.
#pragma once
#include <vector>

#include "camera/sensor.h"

namespace dg {

/// Light per tile of the frame, from rays that landed there.
class FlareTiles {
  public:
    explicit FlareTiles(const Sensor& sensor);

    void add(Vec2f px, double light);
    /// Blurs the tiles, as each has few rays. Call it after the last ray.
    void finish();
    /// 1 / sqrt(R^2 + (0.1 mean)^2) with R the light of a pixel: weight of an absolute error there, as in relMSE. Light
    /// below a tenth of the mean need not be accurate.
    float importance(Vec2f px) const { return importance_[index(px)]; }
    /// Mean light per tile.
    double mean() const { return mean_; }
    std::size_t count() const { return light_.size(); }
    /// Index of the tile at a film position; positions outside the frame are clamped.
    std::size_t index(Vec2f px) const;
    float importance(std::size_t tile) const { return importance_[tile]; }
    /// Approximate number of pixels per tile.
    double area() const { return 1 / (double(per_px_) * per_px_); }

  private:

    int columns_, rows_;
    float per_px_;
    double mean_ = 0;
    std::vector<double> light_;
    std::vector<float> importance_;
};

}  // namespace dg
