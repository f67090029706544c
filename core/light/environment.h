// environment.h -- light from infinity: an equirectangular picture, or a uniform colour.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "math/transform.h"
#include "motion/keyed.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// In the picture, row 0 is the zenith (+y up, as in glTF), the center column is in the direction -z, and 1.0 is
/// `scale` cd/m2. Lookup is bilinear, and wraps in azimuth. Sampling uses the luminance of the same bilinear function
/// (with rows interpolated in cos theta), or the mean of blocks in which it differs little (sky_blocks.h), so that
/// pdf > 0 wherever radiance > 0.
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;
};

/// Animated parameters of an environment.
struct EnvironmentPose {
    Rgb strength{1, 1, 1};  // factor on the picture or the colour
    float turn = 0;         // rad about +y, right-handed; applied after the picture's transform
};
EnvironmentPose blend(const EnvironmentPose& a, const EnvironmentPose& b, float share);

/// Time is the fraction of the scene's interval.
class Environment {
  public:
    static Environment constant(Rgb luminance);
    /// Throws Error for a wrong size, for negative or non-finite values (naming row and column), and for a transform
    /// that is not a rotation.
    static Environment image(EnvironmentImage image, float scale,
                             const Affine3f& world_from_environment);
    /// A copy with poses over time. Throws Error for a pose that is not finite or has a negative strength.
    Environment posed(Keyed<EnvironmentPose> poses) const;
    /// A copy for light sampling that is combined with BSDF sampling: samples leave the even part of the picture to the
    /// other strategy (sky_grid.h). The light is the same.
    Environment compensated() const;

    Rgb luminance(Vec3f direction, float time) const {
        return poses_ ? luminance_posed(direction, time) : luminance_within(direction);
    }
    struct Sample {
        Vec3f direction;
        float pdf;
        float luminance = 0;  // estimate of the luminance from there, cd/m2; > 0 where the luminance is
    };
    Sample sample(Vec2f u, float time) const {
        return poses_ ? sample_posed(u, time) : sample_within(u);
    }
    float pdf(Vec3f direction, float time) const {
        return poses_ ? pdf_posed(direction, time) : pdf_within(direction);
    }
    /// luminance() and pdf() in one look-up.
    struct Lookup {
        Rgb luminance;
        float pdf;
    };
    Lookup lookup(Vec3f direction, float time) const;
    /// Converts directions between world and picture at a time. Identity for a uniform colour.
    Vec3f to_picture(Vec3f direction, float time) const;
    Vec3f to_world(Vec3f direction, float time) const;
    bool is_constant() const { return !picture_; }
    float mean_luminance() const { return mean_luminance_; }  // over the sphere; maximum over time

  private:
    friend class HotSky;
    struct Picture;
    Rgb luminance_within(Vec3f direction) const;
    Sample sample_within(Vec2f u) const;
    float pdf_within(Vec3f direction) const;
    Lookup lookup_within(Vec3f direction) const;
    Vec3f turned(Vec3f direction, float time, float sign) const;
    Rgb luminance_posed(Vec3f direction, float time) const;
    Sample sample_posed(Vec2f u, float time) const;
    float pdf_posed(Vec3f direction, float time) const;
    std::shared_ptr<const Picture> picture_;  // null: uniform colour
    Rgb constant_{};
    float mean_luminance_ = 0;
    std::shared_ptr<const Keyed<EnvironmentPose>> poses_;  // null: static
};

}  // namespace dg
