// light.cpp -- the lights of a scene, and the choice among them.
#include "light/light.h"

#include "light/emitter.h"
#include "light/emitter_check.h"
#include "light/triangle_sampler.h"

namespace dg {
namespace {

// Neither the lights from infinity nor those nearby ever get less than this share where
// both shine: the estimate knows nothing of walls between.
constexpr float kLeastShare = 0.1f;
// Nor any one light from infinity less than this share of their group.
constexpr double kLeastInfiniteShare = 0.05;

const char* kind_name(const Light& light) {
    constexpr const char* names[] = {"point", "spot", "directional", "sphere",
                                     "triangle"};
    return names[light.index()];
}

/// A light that the tree takes to be everywhere, so that only its intensity counts.
LightBounds placeless(float intensity) {
    constexpr float kFar = 1e9f;
    LightBounds b;
    b.min = {-kFar, -kFar, -kFar};
    b.max = {kFar, kFar, kFar};
    b.intensity = intensity;
    return b;
}

}  // namespace

LightSet::LightSet() = default;
LightSet::~LightSet() = default;
LightSet::LightSet(LightSet&&) noexcept = default;
LightSet& LightSet::operator=(LightSet&&) noexcept = default;

LightSet::LightSet(std::vector<Light> lights, std::optional<Environment> environment,
                   LightChoice choice)
    : lights_(std::move(lights)), environment_(std::move(environment)) {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const std::string where =
            "light " + std::to_string(i) + " (" + kind_name(lights_[i]) + ")";
        std::visit([&](const auto& light) { check_emitter(light, where); }, lights_[i]);
    }
    build_groups(choice);
    build_lookup();
}

void LightSet::build_groups(LightChoice choice) {
    std::vector<LightBounds> bounds;
    std::vector<double> weights;
    tree_index_.assign(lights_.size(), kNone);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (const auto* sun = std::get_if<DirectionalLight>(&lights_[i])) {
            const float lux = selection_weight(sun->illuminance);
            if (lux <= 0) continue;
            infinite_lights_.push_back(static_cast<std::int32_t>(i));
            weights.push_back(lux);
            continue;
        }
        LightBounds b =
            std::visit([](const auto& l) { return emitter_bounds(l); }, lights_[i]);
        if (!(b.intensity > 0) || !std::isfinite(b.intensity)) continue;
        if (choice != LightChoice::tree)
            b = placeless(choice == LightChoice::power ? b.intensity : 1);
        tree_index_[i] = static_cast<std::int32_t>(bounds.size());
        tree_lights_.push_back(static_cast<std::uint32_t>(i));
        bounds.push_back(b);
        const auto* triangle = std::get_if<TriangleLight>(&lights_[i]);
        triangles_.push_back(triangle ? TriangleSampler(*triangle) : TriangleSampler());
    }
    tree_ = LightTree(bounds);

    // An even sky is left to the BSDF: following its lobe is already sampling in
    // proportion to the light, and every shadow ray goes to a light that needs one.
    if (environment_ && !environment_->is_constant() &&
        environment_->mean_luminance() > 0) {
        infinite_lights_.push_back(kEnvironment);
        weights.push_back(kPiD *
                          environment_->mean_luminance());  // E = pi L under an even sky
    }
    double sum = 0;
    for (double w : weights) sum += w;
    infinite_illuminance_ = static_cast<float>(sum);
    for (double& w : weights) w = std::max(w, kLeastInfiniteShare * sum);
    if (!weights.empty())
        infinite_ = DiscreteDistribution(std::span<const double>(weights));
    if (!weights.empty() && infinite_lights_.back() == kEnvironment) {
        environment_pmf_ = infinite_.pmf(infinite_.size() - 1);
    }
}

void LightSet::build_lookup() {
    std::vector<std::uint32_t> primitives;  // by instance, one more than the largest
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (std::holds_alternative<SphereLight>(lights_[i]))
            spheres_.push_back(static_cast<std::uint32_t>(i));
        const auto* t = std::get_if<TriangleLight>(&lights_[i]);
        if (!t) continue;
        if (t->instance >= primitives.size()) primitives.resize(t->instance + 1, 0);
        primitives[t->instance] = std::max(primitives[t->instance], t->primitive + 1);
    }
    first_slot_.assign(primitives.size(), -1);
    std::int64_t slots = 0;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (primitives[i] == 0) continue;
        first_slot_[i] = slots;
        slots += primitives[i];
    }
    // A primitive beyond the last light of its instance would find a slot of the next
    // instance; it is told apart by the instance and primitive that the light itself
    // names.
    triangle_slots_.assign(slots, kNone);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const auto* t = std::get_if<TriangleLight>(&lights_[i]);
        if (t)
            triangle_slots_[first_slot_[t->instance] + t->primitive] =
                static_cast<std::int32_t>(i);
    }
}

float LightSet::infinite_probability(Vec3f position) const {
    if (infinite_.empty()) return 0;
    if (tree_.empty()) return 1;
    return infinite_share(tree_.importance(position));
}

/// Among all lights, where those nearby bring `local` lux.
float LightSet::infinite_share(float local) const {
    if (infinite_.empty()) return 0;
    if (!(local > 0)) return 1;
    const float share = infinite_illuminance_ / (infinite_illuminance_ + local);
    return std::clamp(share, kLeastShare, 1 - kLeastShare);
}

float LightSet::local_probability(Vec3f position, std::size_t light) const {
    if (tree_index_[light] == kNone) return 0;
    return (1 - infinite_probability(position)) *
           tree_.probability(position, tree_index_[light]);
}

std::optional<LightSample> LightSet::sample(float u_select, Vec2f u, Vec3f position,
                                            const Wavelengths& wavelengths) const {
    if (empty()) return std::nullopt;
    LightTree::Weights weights;
    weights.sum = 0;
    if (!tree_.empty()) weights = tree_.weigh(position);
    const float p_infinite = infinite_share(weights.sum);
    if (u_select < p_infinite) {
        const float rest = std::min(u_select / p_infinite, 0x1.fffffep-1f);
        return sample_infinite(rest, p_infinite, u, wavelengths);
    }
    const float rest = (u_select - p_infinite) / (1 - p_infinite);
    const auto choice = tree_.sample(weights, position, std::min(rest, 0x1.fffffep-1f));
    if (!choice) return std::nullopt;
    const std::uint32_t light = tree_lights_[choice->light];
    const TriangleSampler& triangle = triangles_[choice->light];
    EmitterSample s;
    if (triangle.area > 0) {
        if (!triangle.sample(u, position, s)) return std::nullopt;
    } else {
        const auto found =
            std::visit([&](const auto& l) { return sample_emitter(l, u, position); },
                       lights_[light]);
        if (!found) return std::nullopt;
        s = *found;
    }
    const bool is_triangle = triangle.area > 0;
    return LightSample{s.wi,
                       s.distance,
                       wavelengths.emission(s.value),
                       s.pdf * ((1 - p_infinite) * choice->probability),
                       s.delta,
                       is_triangle ? std::int64_t(light) : -1,
                       s.barycentric,
                       is_triangle && !triangle.even};
}

std::optional<LightSample> LightSet::sample_infinite(
    float u_select, float p_infinite, Vec2f u, const Wavelengths& wavelengths) const {
    const DiscreteSample choice = infinite_.sample(u_select);
    const float probability = p_infinite * choice.pmf;
    const std::int32_t light = infinite_lights_[choice.index];
    LightSample sample{};
    sample.distance = std::numeric_limits<float>::infinity();
    if (light == kEnvironment) {
        const Environment::Sample s = environment_->sample(u);
        if (!(s.pdf > 0)) return std::nullopt;
        sample.wi = s.direction;
        sample.radiance = environment_radiance(s.direction, wavelengths);
        sample.pdf = s.pdf * probability;
        return sample;
    }
    const auto s = sample_emitter(std::get<DirectionalLight>(lights_[light]), u, {});
    sample.wi = s->wi;
    sample.radiance = wavelengths.emission(s->value);
    sample.pdf = s->pdf * probability;
    sample.delta = true;
    return sample;
}

float LightSet::pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float t,
                             float cos_light, Vec3f position) const {
    if (instance >= first_slot_.size() || first_slot_[instance] < 0) return 0;
    const std::size_t slot = first_slot_[instance] + primitive;
    if (slot >= triangle_slots_.size() || triangle_slots_[slot] == kNone) return 0;
    const std::size_t light = triangle_slots_[slot];
    const auto& triangle = std::get<TriangleLight>(lights_[light]);
    if (triangle.instance != instance || triangle.primitive != primitive) return 0;
    if (tree_index_[light] == kNone) return 0;
    return triangles_[tree_index_[light]].pdf(t, cos_light) *
           local_probability(position, light);
}

float LightSet::pdf_sphere(std::uint32_t sphere, Vec3f position) const {
    const std::size_t light = spheres_[sphere];
    return emitter_pdf(std::get<SphereLight>(lights_[light]), position) *
           local_probability(position, light);
}

float LightSet::pdf_environment(Vec3f direction, Vec3f position) const {
    if (environment_pmf_ <= 0) return 0;
    return infinite_probability(position) * environment_pmf_ *
           environment_->pdf(direction);
}

Spectrum LightSet::sphere_radiance(std::uint32_t sphere,
                                   const Wavelengths& wavelengths) const {
    return wavelengths.emission(
        std::get<SphereLight>(lights_[spheres_[sphere]]).luminance);
}

Spectrum LightSet::environment_radiance(Vec3f direction,
                                        const Wavelengths& wavelengths) const {
    if (!environment_) return Spectrum(0.f);
    return wavelengths.emission(environment_->luminance(direction));
}

}  // namespace dg
