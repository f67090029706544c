// solids_near_camera.h -- solids that a camera may be inside of.
#pragma once
#include <cstdint>
#include <vector>

#include "camera/camera.h"
#include "scene/scene.h"

namespace dg {

/// Solids, by index, near any place of the camera during the exposure; for PathSettings::solids_near.
std::vector<std::uint32_t> solids_near_camera(const Scene& scene, const Camera& camera);

}  // namespace dg
