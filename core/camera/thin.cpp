#include "camera/thin.h"

#include "math/warp.h"

namespace dg {

/// On the iris of unit radius, with the weight of what passes there; `covered`: the sampled region may
/// exceed the shape.
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
        weight *= exposure * s.iris_opening * s.iris_opening;   // the area that is open
        const Vec3f origin{p.x * radius, p.y * radius, 0};
        // The chief ray, of length 1 along the axis, meets the plane of focus at chief * focus; divided
        // by focus, infinity needs no case of its own.
        const Vec3f chief{s.film_mm.x * inverse_film, s.film_mm.y * inverse_film, -1};
        if (natural_vignetting) {
            const float cos2 = 1 / length_squared(chief);
            weight *= cos2 * cos2;
        }
        const Vec3f direction = normalize(chief - origin * inverse_focus);
        rays[i].ray = Ray{.origin = origin, .direction = direction, .time = s.time};
        rays[i].weight = weight;
    }
}

// A film point lies at -D c of the centre, with c = (x / D, y / D, -1) its chief ray and D the film's
// distance: at the depth D (c . a) behind the lens, whose axis is a. The thin lens formula puts its image at
// the depth t (c . a) before it, t = 1 / w along the chief ray, with
//   w = (c . a) / f - 1 / D,  1 / f = a_z / D + 1 / focus,
// so that the axis is in focus where it should be. w is linear over the film: the image is a plane.
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
        if (natural_vignetting) {   // both cosines over the distance squared, 1 / |c|^2 less
            const double cos2 = 1 / length_squared(chief);
            exposure *= along * cos2 * cos2;
        }
        rays[i].ray = Ray{.origin = to_float(origin),
                          .direction = to_float(normalize(direction)),
                          .time = s.time};
        rays[i].weight = along > 0 && direction.z < 0 ? float(weight * exposure) : 0.f;
    }
}

}  // namespace dg
