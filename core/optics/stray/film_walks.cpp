#include "optics/stray/film_walks.h"

#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "optics/first_order/paraxial.h"

namespace dg {
namespace {

/// Disc in the plane of the last vertex.
struct Disc {
    Vec2d middle;
    double radius;

    double density(Vec2d p) const { return length(p - middle) < radius ? 1 / (kPiD * radius * radius) : 0; }
};

/// Disc that contains all rays from a spot of film to the last surface: the rim, enlarged for its
/// distance from the vertex plane.
Disc whole_surface(const ScatterLens& lens, const FilmSpot& spot, double last) {
    const ScatterLens::Rim rim = lens.rims().back();
    const double reach = (length(spot.point) + spot.radius + rim.radius) / (lens.ghosts().film().center.z - last);
    return {{}, rim.radius + std::abs(rim.z - last) * reach};
}

/// Exit pupil as seen from a film point, projected on the plane of the last vertex, with a margin.
Disc pupil(const FirstOrder& order, const Vec3d& from, double last) {
    constexpr double kMargin = 1.25;
    if (!std::isfinite(order.exit_pupil_z))
        return {{from.x, from.y}, kMargin * std::abs(from.z - last) / (2 * order.f_number)};
    const double share = (last - from.z) / (order.exit_pupil_z - from.z);
    return {Vec2d{from.x, from.y} * (1 - share), kMargin * 0.5 * std::abs(share * order.exit_pupil_diameter)};
}

}  // namespace

/// Mixture sampling with the balance heuristic (Veach and Guibas 1995): half of the walks start
/// toward the exit pupil, which carries the image, half toward the whole last surface. The last
/// surface may be a cover glass right in front of the film, which scatters light from the whole
/// hemisphere.
std::vector<FilmWalk> film_walks(const ScatterLens& lens, const FilmSpot& spot) {
    const FilmPlane& film = lens.ghosts().film();
    const Tracer& tracer = lens.ghosts().tracer();
    const double last = tracer.vertices()[lens.rims().size() - 1];
    const FirstOrder order = first_order(tracer.prescription());
    const Disc surface = whole_surface(lens, spot, last);
    const LensIndices n = lens.at(spot.wavelength_nm);
    const ScatterDraw draw{.toward_film = false, .all = true};
    std::vector<FilmWalk> out;
    for (int i = 0; i < spot.walks; ++i) {
        const auto u = [&, k = std::uint64_t(i) * 4](int d) { return hash_uniform(hash64(spot.seed, 1), k + d); };
        const Vec3d from = film.at(spot.point + concentric_disc({u(0), u(1)}) * spot.radius);
        const Disc open = pupil(order, from, last), &aim = i % 2 ? surface : open;
        const Vec2d q = aim.middle + concentric_disc({u(2), u(3)}) * aim.radius;
        const Vec3d way = Vec3d{q.x, q.y, last} - from;
        const double cosine = -way.z / length(way);
        LensRay left;
        const auto light = lens.walk({from, normalize(way)}, n, 1, hash64(spot.seed, 2, std::uint64_t(i)), draw,
                                     nullptr, &left);
        if (!light) continue;
        const double density = 0.5 * (surface.density(q) + open.density(q));
        const double etendue = std::pow(cosine, 4) / (way.z * way.z * density);
        out.push_back({left.direction, etendue * light->weight / spot.walks, light->events});
    }
    return out;
}

}  // namespace dg
