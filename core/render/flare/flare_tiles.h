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

  private:
    std::size_t index(Vec2f px) const;

    int columns_, rows_;
    float per_px_;
    std::vector<double> light_;
    std::vector<float> importance_;
};

}  // namespace dg
