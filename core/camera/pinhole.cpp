#include "camera/pinhole.h"

namespace dg {

void Pinhole::generate(std::span<const CameraSample> samples,
                       std::span<CameraRay> rays) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec2f film = samples[i].film_mm;
        const Vec3f direction = normalize(Vec3f{film.x, film.y, -float(film_distance_mm)});
        const float cosine = -direction.z;
        rays[i].ray = Ray{.origin = {}, .direction = direction, .time = samples[i].time};
        const float opening = samples[i].iris_opening;
        rays[i].weight = opening * opening;
        if (natural_vignetting) rays[i].weight *= cosine * cosine * cosine * cosine;
    }
}

}  // namespace dg
