// frame_view.h -- what the frame may see of the world, as cones (light/view_cone.h).
#pragma once
#include <vector>

#include "camera/camera.h"
#include "camera/sensor.h"
#include "light/view_cone.h"

namespace dg {

/// Cones that hold the rays of all film points of the frame, and of a margin around it (px), at times close
/// to all others: one where neither camera nor lens nor the world (`moves`) does anything meanwhile.
std::vector<ViewCone> frame_views(const Camera& camera, const Sensor& sensor, float margin_px,
                                  bool moves);

}  // namespace dg
