#include "camera/thin.h"

#include "math/warp.h"

namespace dg {

void ThinLens::generate(const Numbers& numbers, std::span<const CameraSample> samples,
                        std::span<CameraRay> rays) const {
    const float unit_m = float(numbers.aperture_radius_mm * 1e-3);
    const float inverse_film = float(1 / numbers.film_distance_mm);
    const float inverse_focus = float(numbers.inverse_focus);
    const float exposure = float(numbers.exposure);
    const bool round = iris.kind() == Iris::Kind::round;
    const double covered = iris.sampling_area() / kPiD;   // the sampled region may exceed the shape
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        Vec2f p;
        float weight = 1;
        if (round) {
            p = warp_disk(s.u_lens);
        } else {
            const Vec2d q = iris.sample({s.u_lens.x, s.u_lens.y});
            p = {float(q.x), float(q.y)};
            weight = float(covered * iris.transmission(q));
        }
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

}  // namespace dg
