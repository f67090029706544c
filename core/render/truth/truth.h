// truth.h -- ground truth: what each pixel's chief ray meets at the pixel's own moment,
// exactly and not averaged over lens and time, and where the same surface points lie in
// another frame.
//
// A frame is a scene and a camera built over its moments: a shutter whose exposure has no
// length tells them apart by line, if it rolls. Surface points are followed by instance,
// triangle and barycentrics, so frames that are compared are of one scene, built at
// different times.
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

/// Sight of a camera ray: a surface, or a direction at infinity.
struct Seen {
    RawHit hit;
    bool surface = false;
    Vec3f direction;  // unit: the surface's normal in the world, or where in the sky
};

/// Planes of the pixels of a region, in rows from the top. Where there is no surface all is 0.
struct TruthPlanes {
    explicit TruthPlanes(const FilmLayout& region);

    FilmLayout region;
    std::vector<float> depth, distance;   // m: along the camera's -z; from its origin
    std::vector<Vec3f> position, normal;  // world; m, unit
    std::vector<std::uint32_t> object_id,
        material_id;  // index + 1; 0: none, as of sphere lights
};

struct Truth : TruthPlanes {
    explicit Truth(const FilmLayout& region);

    std::vector<Seen> seen;
};

/// Surface point that a ray meets, where it meets one.
struct TruthPoint {
    float depth, distance;
    Vec3f position, normal;
    std::uint32_t object_id = 0, material_id = 0;
};
/// `camera`: its pose at the ray's time.
TruthPoint truth_point(const Scene& scene, const Ray& ray, const RawHit& hit,
                       const Affine3d& camera);

/// Chief rays through the centres of the pixels, to the nearest surface that is not cut
/// out. Of the settings sensor, shutter and threads count.
Truth see(const TruthFrame& frame, const FilmLayout& region,
          const RenderSettings& settings);

/// Where (px, of the full frame) what was seen lies in `frame`, at the moment of the line
/// on which it lands; NaN where it is not there, or behind the camera.
std::vector<Vec2d> places(const Truth& truth, const TruthFrame& frame,
                          const RenderSettings& settings);

}  // namespace dg
