// flare_tiles.h -- how bright the flare is over the frame, coarsely: what an error is relative to.
#pragma once
#include <vector>

#include "camera/sensor.h"

namespace dg {

/// Light in tiles of the frame, from rays that landed there.
class FlareTiles {
  public:
    explicit FlareTiles(const Sensor& sensor);

    void add(Vec2f px, double light);
    /// After all is added: blurs it, as a tile has few rays.
    void finish();
    /// 1 / sqrt(R^2 + (0.1 mean)^2) with R the light of a pixel: what light is an error there, as the eye has it
    /// and as relMSE does. What is darker than a tenth of the mean need not be exact.
    float importance(Vec2f px) const { return importance_[index(px)]; }
    /// Light of a tile in the mean.
    double mean() const { return mean_; }
    std::size_t count() const { return light_.size(); }
    /// The tile of a place, the nearest of one beside the frame.
    std::size_t index(Vec2f px) const;
    float importance(std::size_t tile) const { return importance_[tile]; }
    /// Pixels of a tile, about.
    double area() const { return 1 / (double(per_px_) * per_px_); }

  private:

    int columns_, rows_;
    float per_px_;
    double mean_ = 0;
    std::vector<double> light_;
    std::vector<float> importance_;
};

}  // namespace dg
