// light_choice.cpp -- the choice of a light by itself, for whoever samples it from elsewhere than it was chosen for.
#include "light/emitter.h"
#include "light/light.h"
#include "light/triangle_sampler.h"

namespace dg {
namespace {

constexpr float kAlmostOne = 0x1.fffffep-1f;

}  // namespace

std::optional<LightSet::Choice> LightSet::choose(float u, Vec3f position) const {
    if (empty()) return std::nullopt;
    LightTree::Weights weights;
    weights.sum = 0;
    if (!tree_.empty()) weights = tree_.weigh<true>(position);
    const float p_infinite = infinite_share(weights.sum);
    if (u < p_infinite) {
        const DiscreteSample found = infinite_.sample(std::min(u / p_infinite, kAlmostOne));
        return Choice{infinite_lights_[found.index], p_infinite * found.pmf};
    }
    const auto found = tree_.sample<true>(weights, position, std::min((u - p_infinite) / (1 - p_infinite), kAlmostOne));
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

std::optional<Vec3f> LightSet::place_of(std::int32_t light, Vec2f u, float time) const {
    if (light == kEnvironment) return std::nullopt;
    if (std::holds_alternative<TriangleLight>(lights_[light])) {
        const auto now = triangle_at(light, time);
        if (!now) return std::nullopt;
        const Vec2f b = warp_triangle(u);
        return now->a + (now->b - now->a) * b.x + (now->c - now->a) * b.y;
    }
    const Light now = light_at(light, time);
    if (const auto* point = std::get_if<PointLight>(&now)) return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&now)) return spot->position;
    if (const auto* sphere = std::get_if<SphereLight>(&now)) return to_float(to_double(sphere->shape.center));
    return std::nullopt;
}

}  // namespace dg
