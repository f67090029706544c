#include "camera/camera.h"

#include <algorithm>

#include "camera/lens_motion.h"

namespace dg {
namespace {

template <typename Lens>
void reproject_still(const Lens& lens, std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                     std::span<Reprojection> out) {
    if constexpr (ReprojectsByWavelength<Lens>)
        lens.reproject(rays, wavelength_nm, out);
    else
        lens.reproject(rays, out);
}

void generate_states(const LensMotion& motion, std::span<const CameraSample> samples, std::span<CameraRay> rays) {
    by_state(motion, samples.size(), [&](std::size_t i) { return samples[i].time; },
             [&](const LensKind& lens, const auto& members) {
                 std::vector<CameraRay> drawn(members.size());
                 const std::vector<CameraSample> in_state = gathered(samples, members);
                 std::visit([&](const auto& kind) { kind.generate(in_state, drawn); }, lens);
                 for (std::size_t i = 0; i < members.size(); ++i) rays[members[i]] = drawn[i];
             });
}

void reproject_states(const LensMotion& motion, std::span<const CameraRay> rays,
                      std::span<const float> wavelength_nm, std::span<Reprojection> out) {
    by_state(motion, rays.size(), [&](std::size_t i) { return rays[i].ray.time; },
             [&](const LensKind& lens, const auto& members) {
                 std::vector<Reprojection> found(members.size());
                 const std::vector<CameraRay> in_state = gathered(rays, members);
                 const std::vector<float> nm = gathered(wavelength_nm, members);
                 std::visit([&](const auto& kind) { reproject_still(kind, in_state, nm, found); }, lens);
                 for (std::size_t i = 0; i < members.size(); ++i) out[members[i]] = found[i];
             });
}

}  // namespace

void generate_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays) {
    const LensMotion& motion = camera.lens_motion;
    std::visit(
        [&]<typename Lens>(const Lens& lens) {
            if (motion.times.empty()) return lens.generate(samples, rays);
            if constexpr (ChangesEvenly<Lens>)
                for (std::size_t i = 0; i < samples.size(); ++i)
                    with_numbers(motion, lens, samples[i].time, [&](const Lens& now, const auto& numbers) {
                        now.generate(numbers, samples.subspan(i, 1), rays.subspan(i, 1));
                    });
            else
                generate_states(motion, samples, rays);
        },
        camera.lens);
}

void reproject(const Camera& camera, std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
               std::span<Reprojection> out) {
    const LensMotion& motion = camera.lens_motion;
    std::visit(
        [&]<typename Lens>(const Lens& lens) {
            if (motion.times.empty()) return reproject_still(lens, rays, wavelength_nm, out);
            if constexpr (ChangesEvenly<Lens>)
                for (std::size_t i = 0; i < rays.size(); ++i)
                    with_numbers(motion, lens, rays[i].ray.time, [&](const Lens& now, const auto& numbers) {
                        now.reproject(numbers, rays.subspan(i, 1), out.subspan(i, 1));
                    });
            else
                reproject_states(motion, rays, wavelength_nm, out);
        },
        camera.lens);
}

void undo_film_shift(const Camera& camera, std::span<const CameraRay> rays, std::span<Reprojection> landings) {
    if (camera.setting.values.empty()) return;
    for (std::size_t i = 0; i < landings.size(); ++i)
        landings[i].film_mm = landings[i].film_mm - setting_at(camera, rays[i].ray.time).film_shift_mm;
}

Ray to_world(const Camera& camera, const Ray& ray) {
    const Affine3d pose = camera.world_from_camera.at(ray.time);
    Ray world = ray;
    world.origin = to_float(pose.point(to_double(ray.origin)));
    world.direction = to_float(pose.vector(to_double(ray.direction)));
    world.t_min = std::max(ray.t_min, float(camera.near_clip.end(to_double(ray.origin), to_double(ray.direction))));
    return world;
}

}  // namespace dg
