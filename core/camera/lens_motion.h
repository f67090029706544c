// lens_motion.h -- lens at the time of each ray, for the functions of camera.h.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "camera/camera.h"

namespace dg {

/// Groups samples by the nearest state, so that lenses get full batches: calls each(lens, indices).
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
std::vector<T> gathered(std::span<const T> from, std::span<const std::uint32_t> members) {
    std::vector<T> values;
    values.reserve(members.size());
    for (const std::uint32_t i : members) values.push_back(from[i]);
    return values;
}

/// Calls use(lens, numbers) with the numbers interpolated at a time; other parameters (the iris)
/// are from the nearer key. Exposure scales with the light cone relative to `middle`, the lens of
/// H0.
template <ChangesEvenly Lens, typename Use>
void with_numbers(const LensMotion& motion, const Lens& middle, float time, const Use& use) {
    const KeyPlace p = place_among(motion.times, time);
    const Lens &first = std::get<Lens>(motion.lenses[p.left]), &second = std::get<Lens>(motion.lenses[p.right]);
    auto now = blend(first.numbers(), second.numbers(), p.share);
    if constexpr (requires { now.light_cone(); }) {
        const double cone = now.light_cone(), usual = middle.numbers().light_cone();
        now.exposure = usual > 0 ? cone / usual : 1;
    }
    use(p.share < 0.5 ? first : second, now);
}

}  // namespace dg
