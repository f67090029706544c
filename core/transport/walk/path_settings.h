// path_settings.h -- settings of a path from the camera.
#pragma once
#include <cstdint>
#include <span>

namespace dg {

class PlateLight;   // catcher/plate_light.h

/// Background seen by the camera: the environment, or nothing, for compositing. In both cases the environment lights
/// the scene.
enum class Background { environment, transparent };

struct PathSettings {
    /// Most vertices at which a path is scattered, on surfaces and in media. Windows (walk.h) are not counted.
    int max_depth = 16;
    int roulette_depth = 2;  // vertices before Russian roulette; see Path::follow() for windows
    int splits = 2;          // smooth clear interfaces, seen by the camera, at which the path follows both lobes
    enum class Strategy { mis, light, bsdf } strategy = Strategy::mis;   // light, bsdf: for tests
    bool caustics = true;    // includes emitters that a path hits after a rough surface and then a specular bounce
    bool visible_emitters = true;   // includes emitters hit by the camera ray itself, also through clear sheets
    Background background = Background::environment;
    bool see_through = false;   // smooth glass leaves alpha open along the unrefracted ray; false: it is opaque
    /// Sampling of the distance of in-scattered light (media/lamp_sampler.h); `equiangular` and `free` are for tests.
    enum class Distances { both, equiangular, free } distances = Distances::both;
    std::span<const std::uint32_t> solids_near = {};   // solids that the camera may be inside of (Scene::solids_near)
    const PlateLight* plate = nullptr;   // photograph that lights objects; null: the materials of catchers do
};

}  // namespace dg
