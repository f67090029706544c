// film_walks.h -- directions from which a spot of film receives light through a lens with
// scattering parts: random walks from the film backward through the lens that leave by the front
// surface.
#pragma once
#include <vector>

#include "optics/stray/scatter_lens.h"

namespace dg {

struct FilmSpot {
    Vec2d point{};       // mm, centre of the disc
    double radius = 0;   // mm
    double wavelength_nm = 550;
    int walks = 1;
    std::uint64_t seed = 0;
};

struct FilmWalk {
    Vec3d direction;   // lens frame, toward the scene
    double weight;     // sr; the sum of all weights is the irradiance on the film under uniform radiance 1
    int events;        // number of scattering events; 0: image light or a ghost
};

/// The walks that leave by the front surface.
std::vector<FilmWalk> film_walks(const ScatterLens& lens, const FilmSpot& spot);

}  // namespace dg
