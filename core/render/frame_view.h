// frame_view.h -- cones that bound the field of view (light/view_cone.h).
#pragma once
#include <vector>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "light/view_cone.h"

namespace dg {

/// Cones that contain the rays of all film points of the frame and of a margin around it (px), for a dense set of
/// times. A single cone if neither the camera nor the lens nor the world (`moves`) changes.
std::vector<ViewCone> frame_views(const Camera& camera, const Sensor& sensor, float margin_px,
                                  bool moves);

}  // namespace dg
