// defocus.h -- synthetic depth of field for pinhole images.
#pragma once
#include <span>
#include <vector>

#include "post/iris_kernel.h"
#include "post/spread.h"

namespace dg {

/// Splats each pixel with the shape of the iris, scaled to its circle of confusion.
///
/// `values`: four per pixel, row-major. `radius`: px per pixel, of the circle with the area of the
/// iris; positive in front of the focus, where the blur is inverted, and negative behind it. It
/// also defines occlusion. Pixels of non-finite radius emit no light. Returns the requested rows.
/// what. A pixel whose radius is not finite gives no light. Returns the rows asked for.
std::vector<float> defocus(int width, std::span<const float> values, std::span<const float> radius,
                           const IrisShape& iris, SpreadRows rows);

}  // namespace dg
