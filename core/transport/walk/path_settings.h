// path_settings.h -- settings of a path from the camera.
#pragma once

namespace dg {

class PlateLight;   // catcher/plate_light.h

/// Background as the lens sees it: the environment, or nothing, so that a photograph can be put there. Either way the
/// environment lights the scene.
enum class Background { environment, transparent };

struct PathSettings {
    int max_depth = 16;      // surface vertices
    int roulette_depth = 2;  // vertices before Russian roulette of weak paths
    int splits = 2;          // smooth clear interfaces, seen from where the path starts, of which it takes both ways
    enum class Strategy { mis, light, bsdf } strategy = Strategy::mis;   // light, bsdf: for tests
    bool caustics = true;    // includes the light that mirrors and smooth glass throw on rough surfaces
    bool straight = true;    // includes emitters that the ray meets first, through clear sheets too
    Background background = Background::environment;
    bool see_through = false;   // smooth glass lets the background pass unbent; false: it covers the background
    /// How light samples in a medium choose their distance (media/lamp_sampler.h); the latter two for tests.
    enum class Distances { both, equiangular, free } distances = Distances::both;
    const PlateLight* plate = nullptr;   // photograph that lights the objects; null: the set's materials do
};

}  // namespace dg
