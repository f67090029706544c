#include "camera/projection.h"

#include <cmath>

#include "math/across.h"
#include "math/warp.h"

namespace dg {
namespace {

/// Converts between the camera frame and the model's frame (y down, z ahead).
Vec3d turned(Vec3d v) {
    return {v.x, -v.y, -v.z};
}

Vec2d model_point(const Projection::Numbers& now, Vec2d film) {
    return {(film.x - now.principal_mm.x) / now.focal_mm.x, (now.principal_mm.y - film.y) / now.focal_mm.y};
}

}  // namespace

void Projection::set(const Numbers& n) {
    focal_mm = n.focal_mm, principal_mm = n.principal_mm;
    aperture_radius_mm = n.aperture_radius_mm, focus_distance_m = 1 / n.inverse_focus;
}

Projection::Numbers blend(const Projection::Numbers& a, const Projection::Numbers& b, double share) {
    const auto mix = [&](auto x, auto y) { return x + (y - x) * share; };
    return {mix(a.focal_mm, b.focal_mm), mix(a.principal_mm, b.principal_mm),
            mix(a.aperture_radius_mm, b.aperture_radius_mm), mix(a.inverse_focus, b.inverse_focus)};
}

Opening Projection::opening(const Numbers& now) const {
    if (!(now.aperture_radius_mm > 0)) return Hole{model.is_wide()};
    return TurningIris{1e-3 * now.aperture_radius_mm * iris.outer_radius(), model.is_wide()};
}

std::optional<Vec3d> Projection::chief_direction(const Numbers& now, Vec2d film) const {
    const auto d = model.unproject(model.continued(model_point(now, film)));
    return d ? std::optional(turned(*d)) : std::nullopt;
}

std::optional<Vec2d> Projection::film_point(const Numbers& now, Vec3d direction) const {
    const auto p = model.project(turned(direction));
    if (!p) return std::nullopt;
    return Vec2d{now.principal_mm.x + now.focal_mm.x * p->x, now.principal_mm.y - now.focal_mm.y * p->y};
}

double Projection::solid_angle(const Numbers& now, Vec2d film) const {
    return model.solid_angle(model_point(now, film)) / (now.focal_mm.x * now.focal_mm.y);
}

void Projection::generate(const Numbers& now, std::span<const CameraSample> samples,
                          std::span<CameraRay> rays) const {
    const double covered = iris.sampling_area() / kPiD;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        rays[i] = {};
        rays[i].iris_opening = s.iris_opening;
        rays[i].ray.time = s.time;
        rays[i].ray.direction = {0, 0, -1};
        const auto chief = chief_direction(now, {s.film_mm.x, s.film_mm.y});
        if (!chief) continue;
        rays[i].weight = float(now.exposure) * s.iris_opening * s.iris_opening;   // open area
        Vec3d origin{0, 0, 0}, direction = *chief;
        if (now.aperture_radius_mm > 0) {
            Vec2d q;
            if (iris.kind() == Iris::Kind::round) {
                const Vec2f disk = warp_disk(s.u_lens);
                q = {disk.x, disk.y};
            } else {
                q = iris.sample({s.u_lens.x, s.u_lens.y});
                rays[i].weight *= float(covered * iris.transmission(q));
            }
            const Across across(*chief);
            const double radius = 1e-3 * now.aperture_radius_mm * s.iris_opening;
            origin = radius * (q.x * across.x + q.y * across.y);
            const double ahead = model.is_wide() ? 1 : -chief->z;   // distance to the plane is 1 / cos
            direction = normalize(*chief - origin * (now.inverse_focus * ahead));
        }
        rays[i].ray.origin = to_float(origin);
        rays[i].ray.direction = to_float(direction);
    }
}

void Projection::reproject(const Numbers& now, std::span<const CameraRay> rays,
                           std::span<Reprojection> out) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        out[i] = now.aperture_radius_mm > 0 ? reproject_iris(now, rays[i]) : reproject_hole(now, rays[i]);
}

/// The hole has measure 1 across the ray: etendue is in sr.
Reprojection Projection::reproject_hole(const Numbers& now, const CameraRay& ray) const {
    const auto film = film_point(now, to_double(ray.ray.direction));
    if (!film || !(ray.iris_opening > 0)) return {};
    const double etendue = solid_angle(now, *film);
    const double weight = now.exposure * ray.iris_opening * ray.iris_opening;
    if (!(etendue > 0)) return {};
    return {{float(film->x), float(film->y)}, 1, float(weight), float(etendue), float(weight / etendue)};
}

/// Intersection of a ray with the surface in focus; the direction, if that is at infinity.
std::optional<Vec3d> Projection::in_focus(const Numbers& now, Vec3d from, Vec3d direction) const {
    if (now.inverse_focus == 0) return direction;
    const double distance = 1 / now.inverse_focus;
    if (!model.is_wide()) {
        if (!(direction.z < 0)) return std::nullopt;
        return from + direction * ((-distance - from.z) / direction.z);
    }
    const double along = dot(from, direction);
    const double inside = along * along + distance * distance - length_squared(from);
    if (!(inside > 0)) return std::nullopt;
    return from + direction * (std::sqrt(inside) - along);
}

// The point P of the ray on the surface in focus determines its chief ray c = P / |P|, and with it
// the film point and the plane of the iris. For constant c, an area dA of the iris and the patch of
// the focus surface with normal n and solid angle dw around c have the etendue
//   dA cos(d, c) . (|P|^2 dw / cos(c, n)) cos(d, n) / (|P|^2 + |o|^2),
// where o is the point on the iris; on a sphere, n = c and cos(c, n) = 1.
Reprojection Projection::reproject_iris(const Numbers& now, const CameraRay& ray) const {
    const Vec3d from = to_double(ray.ray.origin), d = to_double(ray.ray.direction);
    const double opening = ray.iris_opening, radius = 1e-3 * now.aperture_radius_mm * opening;
    const auto point = in_focus(now, from, d);
    if (!point || !(radius > 0)) return {};
    const Vec3d chief = normalize(*point);
    const double ahead = dot(d, chief);
    if (!(ahead > 0)) return {};
    const Vec3d o = from - d * (dot(from, chief) / ahead);
    const Across across(chief);
    const double pass = iris.transmission(Vec2d{dot(o, across.x), dot(o, across.y)} * (1 / radius));
    const auto film = pass > 0 ? film_point(now, chief) : std::nullopt;
    if (!film) return {};
    const double region = iris.sampling_area();
    double etendue = region * radius * radius * ahead * solid_angle(now, *film);
    if (now.inverse_focus > 0) {
        const double far = length_squared(*point);
        const bool plane = !model.is_wide();
        etendue *= far / (far + length_squared(o)) * (plane ? d.z / chief.z : ahead);
    }
    if (!(etendue > 0)) return {};
    const double weight = now.exposure * opening * opening * region / kPiD;
    return {{float(film->x), float(film->y)}, float(pass), float(weight), float(etendue),
            float(weight * pass / etendue)};
}

}  // namespace dg
