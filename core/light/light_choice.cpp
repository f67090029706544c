// light_choice.cpp -- chooses a light without sampling it, for sampling from another point.
#include "light/emitter.h"
#include "light/light.h"
#include "light/light_segment.h"
#include "light/triangle_sampler.h"
#include "math/below_one.h"

namespace dg {
namespace {

constexpr float kLeastExtinction = 1e-6f;   // 1/m

}  // namespace

std::optional<LightSet::Choice> LightSet::choose(float u, const LightSegment& segment) const {
    if (empty()) return std::nullopt;
    LightTree::Weights weights;
    weights.sum = 0;
    if (!tree_.empty()) weights = tree_.weigh(segment);
    // Light from infinity reaches the whole segment; its scattering is estimated by the mean of the phase function.
    const float lit = std::min(segment.length, 1 / std::max(segment.extinction, kLeastExtinction));
    const float p_infinite = infinite_share(weights.sum * kPi / lit);
    if (u < p_infinite) {
        const DiscreteSample found = infinite_.sample(std::min(u / p_infinite, kBelowOne));
        return Choice{infinite_lights_[found.index], p_infinite * found.pmf};
    }
    const auto found = tree_.sample(weights, segment, std::min((u - p_infinite) / (1 - p_infinite), kBelowOne));
    if (!found) return std::nullopt;
    return Choice{std::int32_t(triangles_[found->light].light), (1 - p_infinite) * found->probability};
}

std::optional<LightSample> LightSet::sample_one(std::int32_t light, Vec2f u, Vec3f position, float time,
                                                const Wavelengths& wavelengths) const {
    LightSample found{};
    if (light == kEnvironment || tree_index_[light] == kNone) {
        const auto index = std::ranges::find(infinite_lights_, light) - infinite_lights_.begin();
        if (index == std::ptrdiff_t(infinite_lights_.size())) return std::nullopt;
        return sample_infinite_at(int(index), 1, u, time, wavelengths);
    }
    if (!sample_local({tree_index_[light], 1}, 1, u, position, time, wavelengths, found)) return std::nullopt;
    return found;
}

std::optional<LightSet::Place> LightSet::place_of(std::int32_t light, Vec2f u, float time) const {
    if (light == kEnvironment || tree_index_[light] == kNone) return std::nullopt;
    if (std::holds_alternative<TriangleLight>(lights_[light])) {
        const auto on = [&](const TriangleSampler& t) {
            const Vec2f b = warp_triangle(u);
            return Place{t.a + t.to_b * b.x + t.to_c * b.y, t.two_sided ? Vec3f{} : t.normal()};
        };
        const TriangleSampler& still = triangles_[tree_index_[light]];
        if (!still.moves) return on(still);
        const auto now = triangle_at(light, time);
        if (!now) return std::nullopt;
        return on(TriangleSampler(*now));
    }
    const Light now = light_at(light, time);
    if (const auto* point = std::get_if<PointLight>(&now)) return Place{point->position, {}};
    if (const auto* spot = std::get_if<SpotLight>(&now)) return Place{spot->position, {}};
    if (const auto* sphere = std::get_if<SphereLight>(&now))
        return Place{to_float(to_double(sphere->shape.center)), {}};
    return std::nullopt;
}

}  // namespace dg
