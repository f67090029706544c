// mean_ray.h -- the mean of the rays that a lens draws, for the chief rays of film points.
#pragma once
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "math/vec.h"
#include "optics/lens/glass.h"

namespace dg {

/// Samples of one film point at the design wavelength: side x side cells of the lens.
inline std::vector<CameraSample> lens_cells(Vec2f film_mm, int side) {
    std::vector<CameraSample> samples;
    for (int i = 0; i < side * side; ++i)
        samples.push_back({film_mm,
                           {(i % side + 0.5f) / side, (i / side + 0.5f) / side},
                           0,
                           float(kDesignWavelength)});
    return samples;
}

/// Sum of the directions as they expose the film; 0 if nothing passes.
inline Vec3d summed_direction(std::span<const CameraRay> rays) {
    Vec3d sum{};
    for (const CameraRay& r : rays)
        if (r.weight > 0) sum += double(r.weight) * to_double(r.ray.direction);
    return sum;
}

struct RayMeans {
    Vec3d crossing;  // of the plane through the origin
    Vec3d slope;     // of any length
    double start;    // along the axis
};

/// Means over the planes across a unit axis: of where rays cross them, and of their
/// slopes. Rays that meet in one point have a mean ray through it, whatever their
/// weights. Some ray must pass.
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
