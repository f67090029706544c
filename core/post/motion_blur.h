// motion_blur.h -- motion blur of a picture that was taken in an instant.
#pragma once
#include <span>
#include <vector>

#include "post/spread.h"

namespace dg {

/// While the shutter is open: from `open` to `close`, in frames from the moment of the picture. Of the light
/// `arrived[i]` has come after i equal parts of that time: from 0, never falling, to 1.
struct ShutterTime {
    double open = -0.25, close = 0.25;
    std::vector<double> arrived{0, 1};

    double until(double fraction) const;   // of the light
};

/// Where pixels go until the next frame and where they come from, px to the right and down, two numbers
/// each; they move evenly on either side of the picture's moment.
struct PixelMotion {
    std::span<const float> next, last;
};

/// Spreads each pixel along its way.
///
/// `values`: four per pixel, row by row. `nearness`: larger hides smaller; surfaces farther apart than `step`
/// in it hide each other. A pixel where it or the motion is not finite, or that moves more than 1e5 px while
/// the shutter is open, gives no light. Returns the rows asked for.
std::vector<float> motion_blur(int width, std::span<const float> values, const PixelMotion& motion,
                               std::span<const float> nearness, float step, const ShutterTime& shutter,
                               SpreadRows rows);

}  // namespace dg
