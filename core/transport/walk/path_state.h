// path_state.h -- a camera path as its parts see it: the scene, its random numbers, its state and its results.
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
    FirstHit* first_hit;       // null: nobody asks for it
    Wavelengths wavelengths;   // of the walk: a dispersive interface ends the secondary ones
    Walk walk = {};
    Sight sight = {};
    std::uint64_t rays = 0;

    /// Adds the share of the camera ray that comes by this way to what an object covers, or takes it off (sign -1).
    void cover(std::uint32_t object, float sign) {
        if (walk.open) sight.covers.add(object, sign * walk.share());
    }
};

}  // namespace dg
