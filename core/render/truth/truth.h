// truth.h -- ground truth: the surface point hit by each pixel's chief ray at the time of the pixel, without averaging
// over lens and time, and the position of that surface point in another frame.
//
// A frame is a scene and a camera for a time interval. The shutter has an exposure of 0; a rolling shutter gives each
// line a different time. Surface points are identified by instance, triangle and barycentrics, so frames can be
// compared if they are built from the same scene at different times.
#pragma once
#include <cstdint>
#include <vector>

#include "camera/camera.h"
#include "geometry/crossings.h"
#include "render/render.h"
#include "scene/scene.h"

namespace dg {

struct TruthFrame {
    const Scene& scene;
    const Camera& camera;
};

/// The hit of a camera ray: a surface point, or a direction at infinity.
struct Seen {
    RawHit hit;
    bool surface = false;
    Vec3f direction;  // unit: normal of the surface in the world, or direction in the sky
};

/// Planes of the pixels of a region, row by row from the top. All are 0 where there is no surface.
struct TruthPlanes {
    explicit TruthPlanes(const FilmLayout& region);

    FilmLayout region;
    std::vector<float> depth, distance;   // m: along the camera's -z; from its origin
    std::vector<Vec3f> position, normal;  // world; m, unit
    std::vector<std::uint32_t> object_id,
        material_id;  // index + 1; 0: none, e.g. sphere lights
};

struct Truth : TruthPlanes {
    explicit Truth(const FilmLayout& region);

    std::vector<Seen> seen;
};

/// A surface point hit by a ray.
struct TruthPoint {
    float depth, distance;
    Vec3f position, normal;
    std::uint32_t object_id = 0, material_id = 0;
};
/// `camera`: pose of the camera at the ray's time.
TruthPoint truth_point(const Scene& scene, const Ray& ray, const RawHit& hit,
                       const Affine3d& camera);

/// Traces chief rays of pixel centers to the nearest surface that is not cut out by alpha. Uses only sensor, shutter
/// and threads of the settings.
Truth see(const TruthFrame& frame, const FilmLayout& region,
          const RenderSettings& settings);

/// Positions of the hits in `frame` (px of the full frame), at the time of the line where each is imaged; NaN if it
/// does not exist there or is behind the camera.
std::vector<Vec2d> places(const Truth& truth, const TruthFrame& frame,
                          const RenderSettings& settings);

}  // namespace dg
