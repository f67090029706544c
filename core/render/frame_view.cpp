#include "render/frame_view.h"

#include <algorithm>

namespace dg {
namespace {

constexpr int kMoments = 9;
constexpr int kAcross = 16;   // steps across the frame
// Safety factor for rays between the sampled rays.
constexpr float kWider = 1.05f;
constexpr float kLeastAngle = 2e-3f;   // rad

/// Film points across the frame, each combined with several lens points and wavelengths.
std::vector<CameraSample> samples_of(const Sensor& sensor, float margin, float time) {
    std::vector<CameraSample> samples;
    const Vec2f size{float(sensor.width) + 2 * margin, float(sensor.height) + 2 * margin};
    for (int i = 0; i <= kAcross; ++i)
        for (int j = 0; j <= kAcross; ++j) {
            const Vec2f px{size.x * float(i) / kAcross - margin, size.y * float(j) / kAcross - margin};
            for (int k = 0; k < 8; ++k) {
                const float u = (float(k) + 0.5f) / 8, v = 0.618034f * float(k + i + 3 * j);
                samples.push_back({sensor.mm_from_px(px), {u, v - std::floor(v)}, time,
                                   k % 2 ? 450.f : 650.f});
            }
        }
    return samples;
}

ViewCone view_at(const Camera& camera, const Sensor& sensor, float margin, float time) {
    std::vector<CameraSample> samples = samples_of(sensor, margin, time);
    if (!camera.setting.values.empty())
        for (CameraSample& s : samples) s.film_mm = s.film_mm + camera.setting.at(time).film_shift_mm;
    std::vector<CameraRay> rays(samples.size());
    generate_rays(camera, samples, rays);
    std::erase_if(rays, [](const CameraRay& r) { return !(r.weight > 0); });
    const Affine3d pose = camera.world_from_camera.at(time);
    ViewCone view{{to_float(pose.origin), 0}, time};
    Vec3d sum{};
    for (const CameraRay& r : rays) sum = sum + to_double(r.ray.direction);
    if (!(length(sum) > 0)) return view;   // rays in all directions
    const Vec3d axis = normalize(sum);
    double lowest = 1, farthest = 0;
    for (const CameraRay& r : rays) {
        const Vec3d o = to_double(r.ray.origin), d = to_double(r.ray.direction);
        lowest = std::min(lowest, dot(d, axis));
        farthest = std::max(farthest, length(cross(o, d)));
    }
    view.axis = to_float(normalize(pose.vector(axis)));
    view.half_angle = float(acos(std::clamp(lowest, -1.0, 1.0))) * kWider + kLeastAngle;
    view.from.radius = float(farthest) * kWider;
    return view;
}

}  // namespace

std::vector<ViewCone> frame_views(const Camera& camera, const Sensor& sensor, float margin_px,
                                  bool moves) {
    const bool still = !moves && !camera.world_from_camera.moves() && camera.lens_motion.times.empty() &&
                       !camera.setting.moves();
    std::vector<ViewCone> views;
    const int moments = still ? 1 : kMoments;
    for (int i = 0; i < moments; ++i) {
        const float time = still ? 0.5f : float(i) / (kMoments - 1);
        views.push_back(view_at(camera, sensor, margin_px, time));
    }
    // A view between two sampled times differs from one of them by no more than these differ from each other.
    float turn = 0, step = 0, radius = 0;
    for (std::size_t i = 1; i < views.size(); ++i) {
        turn = std::max(turn, acos(std::clamp(dot(views[i - 1].axis, views[i].axis), -1.f, 1.f)));
        step = std::max(step, length(views[i].from.eye - views[i - 1].from.eye));
    }
    for (const ViewCone& view : views) radius = std::max(radius, view.from.radius);
    for (ViewCone& view : views) {
        view.half_angle = std::min(view.half_angle + turn, float(kPi));
        view.from.radius = radius + step;
    }
    return views;
}

}  // namespace dg
