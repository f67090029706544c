// motion_blur.h -- synthetic motion blur for instantaneous images.
#pragma once
#include <span>
#include <vector>

#include "post/spread.h"

namespace dg {

/// Exposure from `open` to `close`, in frames relative to the image's moment. `arrived[i]` is the
/// fraction of the light after i equal parts of the exposure: non-decreasing from 0 to 1.
struct ShutterTime {
    double open = -0.25, close = 0.25;
    std::vector<double> arrived{0, 1};

    double until(double fraction) const;   // fraction of the light
};

/// Motion of pixels to the next frame and from the previous, two numbers each, px to the right and
/// down; linear on either side of the image's moment.
struct PixelMotion {
    std::span<const float> next, last;
};

/// Splats each pixel along its motion.
///
/// `values`: four per pixel, row-major. `nearness`: larger occludes smaller; surfaces that differ
/// by more than `step` occlude each other. Pixels with non-finite nearness or motion, or that move
/// more than 1e5 px during the exposure, emit no light. Returns the requested rows.
std::vector<float> motion_blur(int width, std::span<const float> values, const PixelMotion& motion,
                               std::span<const float> nearness, float step, const ShutterTime& shutter,
                               SpreadRows rows);

}  // namespace dg
