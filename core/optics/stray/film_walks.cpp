#include "optics/stray/film_walks.h"

#include <algorithm>
#include <cmath>

#include "math/hash.h"

namespace dg {

/// Toward a disc at the last vertex that all rays to the last surface pass: as much wider as its rim is deep.
std::vector<FilmWalk> film_walks(const ScatterLens& lens, const FilmSpot& spot) {
    const ScatterLens::Rim rim = lens.rims().back();
    const FilmPlane& film = lens.ghosts().film();
    const double last = lens.ghosts().tracer().vertices()[lens.rims().size() - 1];
    const double reach = (length(spot.point) + spot.radius + rim.radius) / (film.center.z - last);
    const double radius = rim.radius + std::abs(rim.z - last) * reach;
    const LensIndices n = lens.at(spot.wavelength_nm);
    const ScatterDraw draw{.toward_film = false, .all = true};
    std::vector<FilmWalk> out;
    for (int i = 0; i < spot.walks; ++i) {
        const auto u = [&, k = std::uint64_t(i) * 4](int d) { return hash_uniform(hash64(spot.seed, 1), k + d); };
        const Vec2d p = spot.point + concentric_disc({u(0), u(1)}) * spot.radius,
                    q = concentric_disc({u(2), u(3)}) * radius;
        const Vec3d from = film.at(p), way = Vec3d{q.x, q.y, last} - from;
        const double cosine = -way.z / length(way);
        LensRay left;
        const auto light = lens.walk({from, normalize(way)}, n, 1, hash64(spot.seed, 2, std::uint64_t(i)), draw,
                                     nullptr, &left);
        if (!light) continue;
        const double etendue = std::pow(cosine, 4) / (way.z * way.z) * kPiD * radius * radius;
        out.push_back({left.direction, etendue * light->weight / spot.walks, light->events});
    }
    return out;
}

}  // namespace dg
