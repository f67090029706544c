#include "camera/thin.h"

#include "math/warp.h"

namespace dg {

void ThinLens::set(const Numbers& n) {
    film_distance_mm = n.film_distance_mm, aperture_radius_mm = n.aperture_radius_mm;
    focus_distance_m = 1 / n.inverse_focus, tilt_deg = n.tilt_deg;
}

/// Samples the iris of unit radius, with the weight of the transmitted light; `covered`: ratio of
/// the areas of sampled region and shape.
Vec2f ThinLens::iris_point(Vec2f u, double covered, float& weight) const {
    if (iris.kind() == Iris::Kind::round) {
        weight = 1;
        return warp_disk(u);
    }
    const Vec2d q = iris.sample({u.x, u.y});
    weight = float(covered * iris.transmission(q));
    return {float(q.x), float(q.y)};
}

void ThinLens::generate(const Numbers& numbers, std::span<const CameraSample> samples,
                        std::span<CameraRay> rays) const {
    if (!(numbers.tilt_deg == Vec2d{})) return generate_tilted(numbers, samples, rays);
    const float unit_m = float(numbers.aperture_radius_mm * 1e-3);
    const float inverse_film = float(1 / numbers.film_distance_mm);
    const float inverse_focus = float(numbers.inverse_focus);
    const float exposure = float(numbers.exposure);
    const double covered = iris.sampling_area() / kPiD;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        float weight;
        const Vec2f p = iris_point(s.u_lens, covered, weight);
        const float radius = unit_m * s.iris_opening;
        weight *= exposure * s.iris_opening * s.iris_opening;   // open area
        const Vec3f origin{p.x * radius, p.y * radius, 0};
        // The chief ray, scaled to unit length along the axis, meets the plane of focus at chief *
        // focus. Division by focus avoids a special case for infinity.
        const Vec3f chief{s.film_mm.x * inverse_film, s.film_mm.y * inverse_film, -1};
        if (natural_vignetting) {
            const float cos2 = 1 / length_squared(chief);
            weight *= cos2 * cos2;
        }
        const Vec3f direction = normalize(chief - origin * inverse_focus);
        rays[i].ray = Ray{.origin = origin, .direction = direction, .time = s.time};
        rays[i].weight = weight;
        rays[i].iris_opening = s.iris_opening;
    }
}

// A film point is at -D c from the centre, with chief ray c = (x / D, y / D, -1) and film distance
// D: at depth D (c . a) behind the lens of axis a. The thin lens formula places its image at depth
// t (c . a) in front, t = 1 / w along the chief ray, with
//   w = (c . a) / f - 1 / D,  1 / f = a_z / D + 1 / focus,
// so that the axis is in focus at the focus distance. w is linear over the film: the image is a
// plane.
void ThinLens::generate_tilted(const Numbers& numbers, std::span<const CameraSample> samples,
                               std::span<CameraRay> rays) const {
    const Affine3d turn = lens_turn(numbers.tilt_deg);
    const Vec3d axis = -turn.z;
    const double inverse_film = 1 / numbers.film_distance_mm;
    const double power = 1e3 * inverse_film * turn.z.z + numbers.inverse_focus;   // 1/m
    const double covered = iris.sampling_area() / kPiD;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        float weight;
        const Vec2f p = iris_point(s.u_lens, covered, weight);
        const double radius = 1e-3 * numbers.aperture_radius_mm * s.iris_opening;
        const Vec3d origin = turn.vector({p.x * radius, p.y * radius, 0});
        const Vec3d chief{s.film_mm.x * inverse_film, s.film_mm.y * inverse_film, -1};
        const double along = dot(chief, axis);
        const Vec3d direction = chief - origin * (along * power - 1e3 * inverse_film);
        double exposure = numbers.exposure * s.iris_opening * s.iris_opening;
        if (natural_vignetting) {   // both cosines over the squared distance, in units of D
            const double cos2 = 1 / length_squared(chief);
            exposure *= along * cos2 * cos2;
        }
        rays[i].ray = Ray{.origin = to_float(origin),
                          .direction = to_float(normalize(direction)),
                          .time = s.time};
        rays[i].weight = along > 0 && direction.z < 0 ? float(weight * exposure) : 0.f;
        rays[i].iris_opening = s.iris_opening;
    }
}

// Solves the equations of generate_tilted for the film point. With lens point o (o . a = 0) and the
// unnormalized ray v = s d: v = c - o (power (c . a) - k), so c . a = s (d . a), and c_z = -1 gives
// s. At constant o the directions change with c by dv/dc; an area element of the lens and dc on the
// film have the etendue dA cos dw = dA (v . a) |v . (dv/dx x dv/dy)| / |v|^4 dc.
void ThinLens::reproject(const Numbers& numbers, std::span<const CameraRay> rays,
                         std::span<Reprojection> out) const {
    const Affine3d turn = lens_turn(numbers.tilt_deg);
    const Vec3d axis = -turn.z;
    const double k = 1e3 / numbers.film_distance_mm;   // 1/m
    const double power = k * turn.z.z + numbers.inverse_focus;
    const double region = iris.sampling_area();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3d from = to_double(rays[i].ray.origin), d = to_double(rays[i].ray.direction);
        const double opening = rays[i].iris_opening, ahead = dot(d, axis);
        const double radius = 1e-3 * numbers.aperture_radius_mm * opening;
        out[i] = {};
        if (!(ahead > 0 && d.z < 0 && radius > 0)) continue;
        const Vec3d o = from - d * (dot(from, axis) / ahead);
        const double s = (o.z * k - 1) / (d.z + o.z * ahead * power);
        const double pass = iris.transmission(Vec2d{dot(o, turn.x), dot(o, turn.y)} * (1 / radius));
        if (!(s > 0 && pass > 0)) continue;
        const Vec3d v = s * d, chief = v + o * (s * ahead * power - k);
        const double turning = std::abs(dot(v, cross(Vec3d{1, 0, 0} - o * (power * axis.x),
                                                     Vec3d{0, 1, 0} - o * (power * axis.y))));
        const double etendue = region * radius * radius * ahead * turning / (s * s * s) /
                               (numbers.film_distance_mm * numbers.film_distance_mm);
        double weight = numbers.exposure * opening * opening * region / kPiD;
        if (natural_vignetting) {
            const double cos2 = 1 / length_squared(chief);
            weight *= s * ahead * cos2 * cos2;
        }
        out[i] = {{float(chief.x * numbers.film_distance_mm), float(chief.y * numbers.film_distance_mm)},
                  float(pass),
                  float(weight),
                  float(etendue),
                  float(weight * pass / etendue)};
    }
}

}  // namespace dg
