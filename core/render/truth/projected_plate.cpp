#include "render/truth/projected_plate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {

ProjectedPlate::ProjectedPlate(const Scene& scene, Camera camera, RenderSettings settings, std::vector<Rgb> pixels)
    : camera_(std::move(camera)),
      settings_(std::move(settings)),
      view_({scene, camera_}, settings_),
      pixels_(std::move(pixels)) {
    const std::size_t wanted = std::size_t(settings_.sensor.width) * settings_.sensor.height;
    if (pixels_.size() != wanted)
        throw input_error("plate", "pixels", std::to_string(wanted), std::to_string(pixels_.size()));
}

/// Interpolates bilinearly between pixel centers; the half pixel at the edge is clamped.
std::optional<Rgb> ProjectedPlate::at(Vec3f place, float w, float time) const {
    const auto px = view_.px_of(to_double(place), w, time);
    const int width = settings_.sensor.width, height = settings_.sensor.height;
    if (!px || !(px->x >= 0 && px->y >= 0 && px->x < width && px->y < height)) return std::nullopt;
    const double x = std::clamp(px->x - 0.5, 0.0, width - 1.0), y = std::clamp(px->y - 0.5, 0.0, height - 1.0);
    const int left = int(x), top = int(y), right = std::min(left + 1, width - 1), low = std::min(top + 1, height - 1);
    const float s = float(x - left), t = float(y - top);
    const Rgb above = pixel(left, top) * (1 - s) + pixel(right, top) * s;
    const Rgb below = pixel(left, low) * (1 - s) + pixel(right, low) * s;
    const Rgb shown = above * (1 - t) + below * t;
    if (!(std::isfinite(shown.x) && std::isfinite(shown.y) && std::isfinite(shown.z))) return std::nullopt;
    return Rgb{std::max(0.f, shown.x), std::max(0.f, shown.y), std::max(0.f, shown.z)};
}

Vec3f ProjectedPlate::eye(float time) const { return to_float(camera_.world_from_camera.at(time).origin); }

}  // namespace dg
