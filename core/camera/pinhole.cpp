#include "camera/pinhole.h"

namespace dg {

void Pinhole::generate(const Numbers& numbers, std::span<const CameraSample> samples,
                       std::span<CameraRay> rays) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec2f film = samples[i].film_mm;
        const Vec3f direction = normalize(Vec3f{film.x, film.y, -float(numbers.film_distance_mm)});
        const float cosine = -direction.z;
        rays[i].ray = Ray{.origin = {}, .direction = direction, .time = samples[i].time};
        const float opening = samples[i].iris_opening;
        rays[i].weight = opening * opening;
        if (natural_vignetting) rays[i].weight *= cosine * cosine * cosine * cosine;
        rays[i].iris_opening = opening;
    }
}

void Pinhole::reproject(const Numbers& numbers, std::span<const CameraRay> rays,
                        std::span<Reprojection> out) const {
    const float distance = float(numbers.film_distance_mm);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3f d = rays[i].ray.direction;
        const float opening = rays[i].iris_opening, cosine = -d.z;
        out[i] = {};
        if (!(cosine > 0 && opening > 0)) continue;
        float weight = opening * opening;
        if (natural_vignetting) weight *= cosine * cosine * cosine * cosine;
        const float etendue = cosine * cosine * cosine / (distance * distance);
        const Vec2f film{d.x * (distance / cosine), d.y * (distance / cosine)};
        out[i] = {film, 1, weight, etendue, weight / etendue};
    }
}

}  // namespace dg
