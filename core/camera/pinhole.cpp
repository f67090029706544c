#include "camera/pinhole.h"

namespace dg {

IdealDirection ideal_direction(Vec2f film_mm, float film_distance_mm) {
    const Vec3f d = normalize(Vec3f{film_mm.x, film_mm.y, -film_distance_mm});
    return {d, -d.z};
}

void Pinhole::generate(std::span<const CameraSample> samples,
                       std::span<CameraRay> rays) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto [direction, cosine] =
            ideal_direction(samples[i].film_mm, float(film_distance_mm));
        rays[i].ray = Ray{.origin = {}, .direction = direction, .time = samples[i].time_s};
        rays[i].weight = natural_vignetting ? cosine * cosine * cosine * cosine : 1.f;
    }
}

}  // namespace dg
