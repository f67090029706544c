// defocus.h -- depth of field of a picture that was taken through a pinhole.
#pragma once
#include <span>
#include <vector>

#include "post/iris_kernel.h"
#include "post/spread.h"

namespace dg {

/// Spreads each pixel by the iris, as large as its circle of confusion.
///
/// `values`: four per pixel, row by row. `radius`: of the circle with the iris' area, px, one per pixel;
/// positive before the focus, where the blur stands upside down, negative behind it. It also tells what hides
/// what. A pixel whose radius is not finite gives no light. Returns the rows asked for.
std::vector<float> defocus(int width, std::span<const float> values, std::span<const float> radius,
                           const IrisShape& iris, SpreadRows rows);

}  // namespace dg
