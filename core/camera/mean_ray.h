// mean_ray.h -- mean of a lens's rays, for the chief rays of film points.
#pragma once
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "math/vec.h"
#include "optics/lens/glass.h"

namespace dg {

/// Samples for a film point at the design wavelength: side x side cells of the lens.
inline std::vector<CameraSample> lens_cells(Vec2f film_mm, int side) {
    std::vector<CameraSample> samples;
    for (int i = 0; i < side * side; ++i)
        samples.push_back({film_mm,
                           {(i % side + 0.5f) / side, (i / side + 0.5f) / side},
                           0,
                           float(kDesignWavelength)});
    return samples;
}

/// Sum of directions weighted by exposure; 0 if no ray passes.
inline Vec3d summed_direction(std::span<const CameraRay> rays) {
    Vec3d sum{};
    for (const CameraRay& r : rays)
        if (r.weight > 0) sum += double(r.weight) * to_double(r.ray.direction);
    return sum;
}

struct RayMeans {
    Vec3d crossing;  // mean intersection with the plane through the origin
    Vec3d slope;     // unnormalized
    double start;    // along the axis
};

/// Means over planes across a unit axis: intersection points and slopes of the rays. If all rays
/// meet in a point, the mean ray passes through it for any weights. At least one ray must pass.
inline RayMeans means_across(Vec3d axis, std::span<const CameraRay> rays) {
    Vec3d crossing{}, slope{};
    double start = 0, sum = 0;
    for (const CameraRay& r : rays) {
        if (!(r.weight > 0)) continue;
        const Vec3d o = to_double(r.ray.origin), d = to_double(r.ray.direction);
        const double w = r.weight, along = dot(d, axis), from = dot(o, axis);
        crossing += w * (o - d * (from / along));
        slope += w / along * d;
        start += w * from, sum += w;
    }
    return {crossing / sum, slope, start / sum};
}

}  // namespace dg
