// environment.h -- light from infinity: an equirectangular picture, or one colour.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "math/distribution.h"
#include "math/transform.h"
#include "motion/keyed.h"
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

/// Parts of an environment that may change over time.
struct EnvironmentPose {
    Rgb strength{1, 1, 1};  // times the picture, or the colour
    float turn = 0;         // rad about +y, right-handed; on top of the picture's own transform
};
EnvironmentPose blend(const EnvironmentPose& a, const EnvironmentPose& b, float share);

/// Time is the fraction of the scene's interval.
class Environment {
  public:
    static Environment constant(Rgb luminance);
    /// Throws Error on a wrong size, on values that are negative or not finite (by row
    /// and column), and on a transform that is no rotation.
    static Environment image(EnvironmentImage image, float scale,
                             const Affine3f& world_from_environment);
    /// The same, posed over time. Throws Error on a pose that is not finite, or negative.
    Environment posed(Keyed<EnvironmentPose> poses) const;

    Rgb luminance(Vec3f direction, float time) const {
        return poses_ ? luminance_posed(direction, time) : luminance_within(direction);
    }
    struct Sample {
        Vec3f direction;
        float pdf;
    };
    Sample sample(Vec2f u, float time) const {
        return poses_ ? sample_posed(u, time) : sample_within(u);
    }
    float pdf(Vec3f direction, float time) const {
        return poses_ ? pdf_posed(direction, time) : pdf_within(direction);
    }
    /// A direction as the picture has it, from the one in the world at that time, and back. One colour
    /// has no picture: they are the same.
    Vec3f to_picture(Vec3f direction, float time) const;
    Vec3f to_world(Vec3f direction, float time) const;
    bool is_constant() const { return !picture_; }
    float mean_luminance() const { return mean_luminance_; }  // over the sphere; the largest ever

  private:
    friend class HotSky;
    struct Picture;
    Rgb luminance_within(Vec3f direction) const;
    Sample sample_within(Vec2f u) const;
    float pdf_within(Vec3f direction) const;
    Vec3f turned(Vec3f direction, float time, float sign) const;
    Rgb luminance_posed(Vec3f direction, float time) const;
    Sample sample_posed(Vec2f u, float time) const;
    float pdf_posed(Vec3f direction, float time) const;
    std::shared_ptr<const Picture> picture_;  // absent: constant
    Rgb constant_{};
    float mean_luminance_ = 0;
    std::shared_ptr<const Keyed<EnvironmentPose>> poses_;  // absent: it stays as it is
};

}  // namespace dg
