// film_walks.h -- what a spot of film sees of the world when the parts of the lens scatter: walks that start
// there, go backward and leave by the front.
#pragma once
#include <vector>

#include "optics/stray/scatter_lens.h"

namespace dg {

struct FilmSpot {
    Vec2d point{};       // mm, middle of a disc of the film
    double radius = 0;   // mm
    double wavelength_nm = 550;
    int walks = 1;
    std::uint64_t seed = 0;
};

struct FilmWalk {
    Vec3d direction;   // lens frame, toward the scene
    double weight;     // sr: their sum is the irradiance that a white world of radiance 1 brings
    int events;        // how often it was scattered; 0: the picture, or a ghost
};

/// Those of all walks that leave by the front.
std::vector<FilmWalk> film_walks(const ScatterLens& lens, const FilmSpot& spot);

}  // namespace dg
