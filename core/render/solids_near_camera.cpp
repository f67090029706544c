#include "render/solids_near_camera.h"

#include <algorithm>

namespace dg {
namespace {

/// A box around all points at which camera rays begin.
Box places_of(const Camera& camera) {
    constexpr double kReach = 2;   // m: no lens has its front farther from the camera's position
    constexpr int kSteps = 64;
    Vec3d last = camera.world_from_camera.at(0).origin;
    Box box{last, last};
    double longest = 0;   // step of the camera
    for (int i = 1; i <= kSteps && camera.world_from_camera.moves(); ++i) {
        const Vec3d p = camera.world_from_camera.at(double(i) / kSteps).origin;
        longest = std::max(longest, length(p - last)), last = p;
        for (int k = 0; k < 3; ++k) box.min[k] = std::min(box.min[k], p[k]), box.max[k] = std::max(box.max[k], p[k]);
    }
    const double reach = kReach + longest;
    return {box.min - Vec3d{reach, reach, reach}, box.max + Vec3d{reach, reach, reach}};
}

}  // namespace

std::vector<std::uint32_t> solids_near_camera(const Scene& scene, const Camera& camera) {
    return scene.solids_near(places_of(camera));
}

}  // namespace dg
