// lens_motion.cpp -- rays through a lens that changes while the shutter is open, or through one that stays.
#include <algorithm>

#include "camera/camera.h"

namespace dg {
namespace {

/// Samples of one state at a time, so that the lens sees full batches.
template <typename Each>
void by_state(const LensMotion& motion, std::size_t count, const auto& time_of, const Each& each) {
    thread_local std::vector<std::uint32_t> state, members;
    state.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const KeyPlace p = place_among(motion.times, float(time_of(i)));
        state[i] = std::uint32_t(p.share < 0.5 ? p.left : p.right);
    }
    for (std::uint32_t k = 0; k < motion.lenses.size(); ++k) {
        members.clear();
        for (std::size_t i = 0; i < count; ++i)
            if (state[i] == k) members.push_back(std::uint32_t(i));
        if (!members.empty()) each(motion.lenses[k], members);
    }
}

template <typename T>
std::vector<T> taken(std::span<const T> from, std::span<const std::uint32_t> members) {
    std::vector<T> some;
    some.reserve(members.size());
    for (const std::uint32_t i : members) some.push_back(from[i]);
    return some;
}

void generate_states(const LensMotion& motion, std::span<const CameraSample> samples,
                    std::span<CameraRay> rays) {
    by_state(motion, samples.size(), [&](std::size_t i) { return samples[i].time; },
             [&](const LensKind& lens, const auto& members) {
                 std::vector<CameraRay> drawn(members.size());
                 const std::vector<CameraSample> some = taken(samples, members);
                 std::visit([&](const auto& kind) { kind.generate(some, drawn); }, lens);
                 for (std::size_t i = 0; i < members.size(); ++i) rays[members[i]] = drawn[i];
             });
}

/// A thin lens or a projection with the numbers that it has at some time.
template <typename Lens>
struct LensNow {
    const Lens& lens;
    typename Lens::Numbers numbers;

    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const {
        lens.generate(numbers, samples, rays);
    }
    void reproject(std::span<const CameraRay> rays, std::span<Reprojection> out) const {
        lens.reproject(numbers, rays, out);
    }
};

/// Measure that exposure is proportional to: the square of iris over image distance.
double light_cone(const ThinLens::Numbers& n) {
    const double slope = n.aperture_radius_mm / n.film_distance_mm;
    return slope * slope;
}
double light_cone(const Projection::Numbers& n) {
    return n.aperture_radius_mm * n.aperture_radius_mm / (n.focal_mm.x * n.focal_mm.y);
}

/// Numbers lie between those of the neighbouring keys; an iris is that of the nearer key.
template <typename Use>
void with_ideal(const Camera& camera, float time, const Use& use) {
    const LensMotion& motion = camera.lens_motion;
    const KeyPlace p = place_among(motion.times, time);
    const LensKind &a = motion.lenses[p.left], &b = motion.lenses[p.right];
    if (const auto* pinhole = std::get_if<Pinhole>(&a)) {
        Pinhole now = *pinhole;
        const double next = std::get<Pinhole>(b).film_distance_mm;
        now.film_distance_mm += p.share * (next - now.film_distance_mm);
        return use(now);
    }
    const auto between = [&]<typename Lens>(const Lens& middle) {
        const Lens &first = std::get<Lens>(a), &second = std::get<Lens>(b);
        auto now = blend(first.numbers(), second.numbers(), p.share);
        const double cone = light_cone(now), usual = light_cone(middle.numbers());
        now.exposure = usual > 0 ? cone / usual : 1;
        use(LensNow<Lens>{p.share < 0.5 ? first : second, now});
    };
    if (const auto* projection = std::get_if<Projection>(&camera.lens)) return between(*projection);
    between(std::get<ThinLens>(camera.lens));
}

bool is_ideal(const LensKind& lens) {
    return std::holds_alternative<Pinhole>(lens) || std::holds_alternative<ThinLens>(lens) ||
           std::holds_alternative<Projection>(lens);
}

void reproject_alone(const LensKind& lens, std::span<const CameraRay> rays,
                     std::span<const float> wavelength_nm, std::span<Reprojection> out) {
    std::visit(
        [&](const auto& kind) {
            if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, ExactLens>)
                kind.reproject(rays, wavelength_nm, out);
            else
                kind.reproject(rays, out);
        },
        lens);
}

}  // namespace

void generate_rays(const Camera& camera, std::span<const CameraSample> samples,
                   std::span<CameraRay> rays) {
    const LensMotion& motion = camera.lens_motion;
    if (motion.times.empty()) {
        std::visit([&](const auto& lens) { lens.generate(samples, rays); }, camera.lens);
    } else if (is_ideal(camera.lens)) {
        for (std::size_t i = 0; i < samples.size(); ++i)
            with_ideal(camera, samples[i].time, [&](const auto& lens) {
                lens.generate(samples.subspan(i, 1), rays.subspan(i, 1));
            });
    } else {
        generate_states(motion, samples, rays);
    }
}

void reproject(const Camera& camera, std::span<const CameraRay> rays,
               std::span<const float> wavelength_nm, std::span<Reprojection> out) {
    const LensMotion& motion = camera.lens_motion;
    if (motion.times.empty()) return reproject_alone(camera.lens, rays, wavelength_nm, out);
    if (is_ideal(camera.lens)) {
        for (std::size_t i = 0; i < rays.size(); ++i)
            with_ideal(camera, rays[i].ray.time, [&](const auto& lens) {
                lens.reproject(rays.subspan(i, 1), out.subspan(i, 1));
            });
        return;
    }
    by_state(motion, rays.size(), [&](std::size_t i) { return rays[i].ray.time; },
             [&](const LensKind& lens, const auto& members) {
                 std::vector<Reprojection> found(members.size());
                 reproject_alone(lens, taken(rays, members), taken(wavelength_nm, members), found);
                 for (std::size_t i = 0; i < members.size(); ++i) out[members[i]] = found[i];
             });
}

}  // namespace dg
