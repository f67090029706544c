#include "camera/thin.h"

#include "camera/pinhole.h"

namespace dg {

void ThinLens::generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
    const float unit_m = float(aperture_radius_mm * 1e-3);
    const float inverse_focus = float(1 / focus_distance_m);   // 0 at infinity
    const double covered = iris.sampling_area() / kPiD;   // the sampled region may exceed the shape
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraSample& s = samples[i];
        const Vec2d p = iris.sample({s.u_lens.x, s.u_lens.y});
        const auto [chief, cosine] = ideal_direction(s.film_mm, float(film_distance_mm));
        const Vec3f origin{float(p.x) * unit_m, float(p.y) * unit_m, 0};
        // The chief ray meets the plane of focus at chief / cosine * focus; divided by focus, infinity
        // needs no case of its own.
        const Vec3f direction = normalize(chief * (1 / cosine) - origin * inverse_focus);
        rays[i].ray = Ray{.origin = origin, .direction = direction, .time = s.time_s};
        const float falloff = natural_vignetting ? cosine * cosine * cosine * cosine : 1.f;
        rays[i].weight = float(covered * iris.transmission(p)) * falloff;
    }
}

}  // namespace dg
