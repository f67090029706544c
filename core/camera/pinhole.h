// pinhole.h -- everything is sharp: all rays pass one point. Of a leaf shutter it has the area only.
#pragma once
#include <span>

#include "camera/camera_sample.h"

namespace dg {

/// film_distance_mm fixes the field of view: tan(half angle) = half film / film_distance.
struct Pinhole {
    double film_distance_mm = 50;
    bool natural_vignetting = false;   // darken by cos^4 of the field angle

    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const;
    /// Reprojects rays through the hole, whose measure across the ray is 1: etendue is in sr.
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const;
};

}  // namespace dg
