#include "camera/pinhole.h"

namespace dg {

void Pinhole::generate(std::span<const CameraSample> samples,
                       std::span<CameraRay> rays) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec2f film = samples[i].film_mm;
        const Vec3f direction = normalize(Vec3f{film.x, film.y, -float(film_distance_mm)});
        const float cosine = -direction.z;
        rays[i].ray = Ray{.origin = {}, .direction = direction, .time = samples[i].time_s};
        rays[i].weight = natural_vignetting ? cosine * cosine * cosine * cosine : 1.f;
    }
}

}  // namespace dg
