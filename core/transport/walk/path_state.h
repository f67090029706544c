// path_state.h -- a camera path: the scene, random numbers, the state of the walk, and the results so far.
#pragma once
#include "math/sampler.h"
#include "scene/scene.h"
#include "transport/walk/path_settings.h"
#include "transport/walk/sight.h"
#include "transport/walk/walk.h"

namespace dg {

struct PathState {
    const Scene& scene;
    const PathSettings& settings;
    PathSampler& sampler;
    FirstHit* first_hit;       // null: not needed
    Wavelengths wavelengths;   // a dispersive interface terminates the secondary wavelengths
    WalkState walk = {};
    Sight sight = {};
    std::uint64_t rays = 0;

    /// Adds this branch's share of the camera ray to the coverage of an object, or subtracts it (sign -1). No effect
    /// once the path has been scattered.
    void cover(std::uint32_t object, float sign) {
        if (walk.unscattered) sight.covers.add(object, sign * walk.share());
    }
};

}  // namespace dg
