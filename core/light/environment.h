// environment.h -- light from infinity: an equirectangular picture, or one colour.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "math/distribution.h"
#include "math/transform.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Picture: row 0 is the zenith (+y up, as glTF); the centre column looks along -z; 1.0
/// is `scale` cd/m2. Lookup is bilinear, wrapping in azimuth; sampling follows the
/// luminance of that same bilinear function (its rows interpolated in cos theta), so that
/// pdf > 0 wherever radiance > 0.
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;
};

class Environment {
  public:
    static Environment constant(Rgb luminance);
    /// Throws Error on a wrong size, on values that are negative or not finite (by row
    /// and column), and on a transform that is no rotation.
    static Environment image(EnvironmentImage image, float scale,
                             const Affine3f& world_from_environment);

    Rgb luminance(Vec3f direction) const;
    struct Sample {
        Vec3f direction;
        float pdf;
    };
    Sample sample(Vec2f u) const;
    float pdf(Vec3f direction) const;
    bool is_constant() const { return !picture_; }
    float mean_luminance() const { return mean_luminance_; }  // over the sphere

  private:
    struct Picture;
    std::shared_ptr<const Picture> picture_;  // absent: constant
    Rgb constant_{};
    float mean_luminance_ = 0;
};

}  // namespace dg
