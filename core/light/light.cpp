// light.cpp -- the lights of a scene, and the choice of a light.
#include "light/light.h"

#include "light/emitter.h"
#include "light/emitter_check.h"
#include "light/light_keys.h"
#include "light/triangle_sampler.h"
#include "math/below_one.h"

namespace dg {
namespace {

// Lower bound of the probability of both groups, infinite lights and nearby lights, if both reach a point: the estimate
// ignores occlusion.
constexpr float kLeastShare = 0.1f;
// Lower bound of a light's probability in the group of infinite lights.
constexpr double kLeastInfiniteShare = 0.05;


/// Next point of a low-discrepancy sequence in the unit square, from any starting point. Source: Roberts 2018,
/// The Unreasonable Effectiveness of Quasirandom Sequences (R2).
Vec2f turned(Vec2f u) {
    u = {u.x + 0.75487767f, u.y + 0.56984029f};
    return {u.x < 1 ? u.x : u.x - 1, u.y < 1 ? u.y : u.y - 1};
}

const char* kind_name(const Light& light) {
    constexpr const char* names[] = {"point", "spot", "directional", "sphere",
                                     "triangle"};
    return names[light.index()];
}

/// Bounds for which the tree uses the intensity alone.
LightBounds placeless(float intensity) {
    constexpr float kFar = 1e9f;
    LightBounds b;
    b.min = {-kFar, -kFar, -kFar};
    b.max = {kFar, kFar, kFar};
    b.intensity = intensity;
    return b;
}

}  // namespace

const LampShape* lamp_of(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light)) return &point->lamp;
    if (const auto* sphere = std::get_if<SphereLight>(&light)) return &sphere->lamp;
    return nullptr;
}
LampShape* lamp_of(Light& light) { return const_cast<LampShape*>(lamp_of(std::as_const(light))); }

LightSet::LightSet() = default;
LightSet::~LightSet() = default;
LightSet::LightSet(LightSet&&) noexcept = default;
LightSet& LightSet::operator=(LightSet&&) noexcept = default;

LightSet::LightSet(std::vector<Light> lights, std::optional<Environment> environment,
                   LightChoice choice, LightMotion motion, LightProfiles profiles, SkyDensity sky)
    : lights_(std::move(lights)),
      environment_(std::move(environment)),
      sampled_(sky == SkyDensity::compensated && environment_ ? environment_->compensated() : environment_),
      motion_(std::move(motion)),
      profiles_(std::move(profiles)) {
    std::string where;   // shared by all lights, as allocating a million strings is slow
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        where.assign("light ").append(std::to_string(i)).append(" (").append(kind_name(lights_[i])).append(")");
        std::visit([&](const auto& light) { check_emitter(light, where); }, lights_[i]);
        const auto keys = motion_.keys.find(std::uint32_t(i));
        if (keys != motion_.keys.end()) check_keys(keys->second.values, where);
    }
    take_profiles();
    build_changes();
    build_groups(choice);
    build_lookup();
}

/// Sets the spread of profiles in lamps.
void LightSet::take_profiles() {
    const auto take = [&](Light& light, std::size_t index) {
        LampShape* lamp = lamp_of(light);
        if (!lamp || !lamp->used()) return;
        if (std::size_t(lamp->profile) >= profiles_.list.size())
            throw input_error("light " + std::to_string(index), "profile",
                              "less than " + std::to_string(profiles_.list.size()), std::to_string(lamp->profile));
        const float norm = dot(lamp->rotation, lamp->rotation);
        if (!(std::abs(norm - 1) < 1e-3f))
            throw input_error("light " + std::to_string(index), "axes", "finite numbers", "NaN or infinity");
        lamp->spread = profiles_.list[std::size_t(lamp->profile)]->spread();
    };
    for (std::size_t i = 0; i < lights_.size(); ++i) take(lights_[i], i);
    for (auto& [index, keys] : motion_.keys)
        for (Light& key : keys.values) take(key, index);
}

/// Replaces a light with a single key by that key.
void LightSet::build_changes() {
    for (const auto& [light, keys] : motion_.keys) {
        lights_[light] = keys.values[0];
        if (!keys.moves()) continue;
        keys_.resize(lights_.size(), nullptr);
        keys_[light] = &keys;
    }
}

float LightSet::infinite_weight(std::size_t light) const {
    const auto* sun = std::get_if<DirectionalLight>(&lights_[light]);
    if (!sun) return 0;
    const Keyed<Light>* keys = keys_of(light);
    return keys ? brightest(*keys) : selection_weight(sun->illuminance);
}

LightBounds LightSet::bounds_of(std::size_t light) const {
    const auto moving = motion_.triangles.find(std::uint32_t(light));
    if (moving != motion_.triangles.end()) return moving->second;
    const Keyed<Light>* keys = keys_of(light);
    LightBounds b = keys ? bounds_over(*keys)
                         : std::visit([](const auto& l) { return emitter_bounds(l); }, lights_[light]);
    const LampShape* lamp = lamp_of(lights_[light]);
    if (lamp && lamp->used()) b.intensity *= profiles_.list[std::size_t(lamp->profile)]->peak();
    return b;
}

const LightProfile* LightSet::profile_of(std::size_t light) const {
    if (profiles_.list.empty()) return nullptr;
    std::int32_t profile = -1;
    if (const LampShape* lamp = lamp_of(lights_[light])) profile = lamp->profile;
    const auto* triangle = std::get_if<TriangleLight>(&lights_[light]);
    if (triangle && !profiles_.of_instance.empty()) profile = profiles_.of_instance[triangle->instance];
    return profile < 0 ? nullptr : profiles_.list[std::size_t(profile)].get();
}

Rgb LightSet::shaped(const Light& now, Vec3f away) const {
    const LampShape* lamp = profiles_.list.empty() ? nullptr : lamp_of(now);
    if (!lamp || !lamp->used()) return {1, 1, 1};
    return profiles_.list[std::size_t(lamp->profile)]->at(lamp->local(away));
}

void LightSet::build_groups(LightChoice choice) {
    std::vector<LightBounds> bounds;
    bounds.reserve(lights_.size()), triangles_.reserve(lights_.size());
    std::vector<double> weights;
    tree_index_.assign(lights_.size(), kNone);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (std::holds_alternative<DirectionalLight>(lights_[i])) {
            const float lux = infinite_weight(i);
            if (lux <= 0) continue;
            infinite_lights_.push_back(static_cast<std::int32_t>(i));
            weights.push_back(lux);
            continue;
        }
        LightBounds b = bounds_of(i);
        if (!(b.intensity > 0) || !std::isfinite(b.intensity)) continue;
        if (choice != LightChoice::tree)
            b = placeless(choice == LightChoice::power ? b.intensity : 1);
        bounds.push_back(b);
        add_local(i);
    }
    tree_ = LightTree(bounds);

    // A uniform sky is left to BSDF sampling, which is proportional to its light already, so that shadow rays serve
    // lights that need them.
    if (environment_ && !environment_->is_constant() &&
        environment_->mean_luminance() > 0) {
        infinite_lights_.push_back(kEnvironment);
        weights.push_back(kPiD *
                          environment_->mean_luminance());  // E = pi L under a uniform sky
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

/// Adds a light to the tree.
void LightSet::add_local(std::size_t light) {
    const auto* triangle = std::get_if<TriangleLight>(&lights_[light]);
    tree_index_[light] = static_cast<std::int32_t>(triangles_.size());
    TriangleSampler& sampler = triangles_.emplace_back();
    if (triangle) sampler = TriangleSampler(*triangle);
    sampler.light = static_cast<std::uint32_t>(light);
    sampler.moves = motion_.triangles.contains(std::uint32_t(light));
    if (sampler.moves) sampler.area = 0;
}

void LightSet::build_lookup() {
    std::vector<std::uint32_t> primitives;  // per instance, largest primitive + 1
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
    // A primitive beyond the last light of its instance would access a slot of the next instance. The instance and
    // primitive stored in the light detect that.
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

/// Probability of the group of infinite lights, if nearby lights have an illuminance of `local` lux.
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

std::optional<TriangleLight> LightSet::triangle_at(std::size_t light, float time) const {
    std::optional triangle = std::get<TriangleLight>(lights_[light]);
    const bool moves = tree_index_[light] != kNone && triangles_[tree_index_[light]].moves;
    if (moves && !motion_.place(*triangle, time)) return std::nullopt;
    return triangle;
}

Light LightSet::light_at(std::size_t light, float time) const {
    const Keyed<Light>* keys = keys_of(light);
    return keys ? keys->at(time) : lights_[light];
}

SphereLight LightSet::sphere_light_at(std::size_t light, float time) const {
    const Keyed<Light>* keys = keys_of(light);
    return std::get<SphereLight>(keys ? keys->at(time) : lights_[light]);
}

std::int64_t LightSet::triangle_index(std::uint32_t instance, std::uint32_t primitive) const {
    if (instance >= first_slot_.size() || first_slot_[instance] < 0) return -1;
    const std::size_t slot = first_slot_[instance] + primitive;
    if (slot >= triangle_slots_.size() || triangle_slots_[slot] == kNone) return -1;
    const std::int32_t light = triangle_slots_[slot];
    const auto& triangle = std::get<TriangleLight>(lights_[light]);
    return triangle.instance == instance && triangle.primitive == primitive ? light : -1;
}

/// Empty if the profile is 0 in that direction.
std::optional<EmitterSample> LightSet::with_profile(const Light& now, std::optional<EmitterSample> sample) const {
    if (profiles_.list.empty() || !sample) return sample;
    const LampShape* lamp = lamp_of(now);
    if (!lamp || !lamp->used()) return sample;
    sample->value = sample->value * shaped(now, -sample->wi);
    if (!(max_component(sample->value) > 0)) sample.reset();
    return sample;
}

/// Samples a light that is not a triangle, or is animated.
std::optional<EmitterSample> LightSet::sample_other(std::size_t light, Vec2f u,
                                                    Vec3f position, float time) const {
    const auto toward = [&](const auto& l) { return sample_emitter(l, u, position); };
    if (const Keyed<Light>* keys = keys_of(light)) {
        const Light now = keys->at(time);
        return with_profile(now, std::visit(toward, now));
    }
    if (!std::holds_alternative<TriangleLight>(lights_[light]))
        return with_profile(lights_[light], std::visit(toward, lights_[light]));
    const auto triangle = triangle_at(light, time);
    return triangle ? sample_emitter(*triangle, u, position) : std::nullopt;
}

std::optional<LightSample> LightSet::sample(float u_select, Vec2f u, Vec3f position,
                                            float time,
                                            const Wavelengths& wavelengths) const {
    if (empty()) return std::nullopt;
    LightTree::Weights weights;
    weights.sum = 0;
    const bool asked = !tree_.lone() || !infinite_.empty();
    if (!tree_.empty() && asked) weights = tree_.weigh(position);
    const float p_infinite = infinite_share(weights.sum);
    if (u_select < p_infinite) {
        const float rest = std::min(u_select / p_infinite, kBelowOne);
        return sample_infinite(rest, p_infinite, u, time, wavelengths);
    }
    const float rest = (u_select - p_infinite) / (1 - p_infinite);
    const auto choice = tree_.sample(weights, position, std::min(rest, kBelowOne));
    std::optional<LightSample> found(std::in_place);
    if (!choice || !sample_local(*choice, 1 - p_infinite, u, position, time, wavelengths, *found)) found.reset();
    return found;
}

void LightSet::sample_several(float u_select, Vec2f u, Vec3f position, float time, const Wavelengths& wavelengths,
                              std::span<LightSample> found) const {
    LightTree::Weights weights;
    weights.sum = 0;
    if (!tree_.empty()) weights = tree_.weigh(position);
    const float p_infinite = infinite_share(weights.sum), share = 1 / float(found.size());
    std::array<float, kMostSamples> select;
    std::array<LightTree::Choice, kMostSamples> choices;
    std::size_t far = 0;   // number of samples from infinite lights, which come first
    for (std::size_t i = 0; i < found.size(); ++i) {
        select[i] = std::min((u_select + float(i)) * share, kBelowOne);
        if (select[i] < p_infinite)
            ++far;
        else
            select[i] = std::min((select[i] - p_infinite) / (1 - p_infinite), kBelowOne);
    }
    const std::span<LightTree::Choice> near(choices.data() + far, found.size() - far);
    if (!near.empty()) tree_.sample(weights, position, std::span(select).subspan(far, near.size()), near);
    for (std::size_t i = 0; i < found.size(); ++i) {
        found[i].pdf = 0;
        if (i < far) {
            const float rest = std::min(select[i] / p_infinite, kBelowOne);
            if (const auto one = sample_infinite(rest, p_infinite, u, time, wavelengths)) found[i] = *one;
        } else if (choices[i].probability > 0) {
            sample_local(choices[i], 1 - p_infinite, u, position, time, wavelengths, found[i]);
        }
        u = turned(u);
    }
}

/// False, without a change of pdf, if the light does not reach the point.
bool LightSet::sample_local(const LightTree::Choice& choice, float p_local, Vec2f u, Vec3f position, float time,
                            const Wavelengths& wavelengths, LightSample& out) const {
    const TriangleSampler& triangle = triangles_[choice.light];
    const std::uint32_t light = triangle.light;
    EmitterSample s;
    if (triangle.area > 0) {
        if (!triangle.sample(u, position, s)) return false;
    } else {
        const auto found = sample_other(light, u, position, time);
        if (!found) return false;
        s = *found;
    }
    const bool is_triangle = triangle.area > 0 || triangle.moves;
    out = {s.wi,
           s.distance,
           wavelengths.emission(s.value),
           s.pdf * (p_local * choice.probability),
           s.delta,
           std::int32_t(light),
           s.barycentric,
           is_triangle && !triangle.even,
           s.error};
    return true;
}

std::optional<LightSample> LightSet::sample_infinite(
    float u_select, float p_infinite, Vec2f u, float time,
    const Wavelengths& wavelengths) const {
    if (infinite_lights_.size() == 1) return sample_infinite_at(0, p_infinite, u, time, wavelengths);
    const DiscreteSample choice = infinite_.sample(u_select);
    return sample_infinite_at(choice.index, p_infinite * choice.pmf, u, time, wavelengths);
}

std::optional<LightSample> LightSet::sample_infinite_at(int index, float probability, Vec2f u, float time,
                                                        const Wavelengths& wavelengths) const {
    const std::int32_t light = infinite_lights_[index];
    LightSample sample{};
    sample.distance = std::numeric_limits<float>::infinity();
    if (light == kEnvironment) {
        const Environment::Sample s = sampled_->sample(u, time);
        if (!(s.pdf > 0)) return std::nullopt;
        sample.wi = s.direction;
        sample.radiance = wavelengths.d65 * s.luminance;
        sample.uneven = true;
        sample.pdf = s.pdf * probability;
        return sample;
    }
    sample.light = light;
    const auto s = sample_other(light, u, {}, time);
    sample.wi = s->wi;
    sample.radiance = wavelengths.emission(s->value);
    sample.pdf = s->pdf * probability;
    sample.delta = true;
    return sample;
}

float LightSet::pdf_triangle(std::uint32_t instance, std::uint32_t primitive, float t,
                             float cos_light, Vec3f position, float time) const {
    const std::int64_t light = triangle_index(instance, primitive);
    if (light < 0 || tree_index_[light] == kNone) return 0;
    const TriangleSampler& still = triangles_[tree_index_[light]];
    const float chosen = local_probability(position, light);
    if (!still.moves) return still.pdf(t, cos_light) * chosen;
    const auto now = triangle_at(light, time);
    return now ? emitter_pdf(*now, t, cos_light) * chosen : 0;
}

float LightSet::choice_probability(std::int32_t light, Vec3f position) const {
    if (light >= 0 && tree_index_[light] != kNone) return local_probability(position, std::size_t(light));
    const auto found = std::ranges::find(infinite_lights_, light);
    if (found == infinite_lights_.end()) return 0;
    return infinite_probability(position) *
           infinite_.pmf(int(found - infinite_lights_.begin()));
}

float LightSet::pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance,
                    float time) const {
    if (light == kEnvironment) return pdf_environment(wi, position, time);
    const float chosen = choice_probability(light, position);
    if (!(chosen > 0)) return 0;
    if (std::holds_alternative<SphereLight>(lights_[light]))
        return chosen * emitter_pdf(sphere_light_at(light, time), position);
    if (!std::holds_alternative<TriangleLight>(lights_[light])) return chosen;
    const auto triangle = triangle_at(light, time);
    if (!triangle) return 0;
    const TriangleSampler sampler(*triangle);
    const float cosine = dot(wi, sampler.normal()) / (2 * sampler.area);
    return sampler.area > 0 ? chosen * sampler.pdf(distance, cosine) : 0;
}

float LightSet::pdf_sphere(std::uint32_t sphere, Vec3f position, float time) const {
    return emitter_pdf(sphere_at(sphere, time), position) *
           local_probability(position, spheres_[sphere]);
}

float LightSet::pdf_environment(Vec3f direction, Vec3f position, float time) const {
    if (environment_pmf_ <= 0) return 0;
    return infinite_probability(position) * environment_pmf_ *
           sampled_->pdf(direction, time);
}

Spectrum LightSet::sphere_radiance(std::uint32_t sphere, Vec3f away, float time,
                                   const Wavelengths& wavelengths) const {
    const SphereLight now = sphere_at(sphere, time);
    if (!now.lamp.used()) return wavelengths.emission(now.luminance);
    return wavelengths.emission(now.luminance * shaped(now, away));
}

Spectrum LightSet::environment_radiance(Vec3f direction, float time,
                                        const Wavelengths& wavelengths) const {
    if (!environment_) return Spectrum(0.f);
    return wavelengths.emission(environment_->luminance(direction, time));
}

LightSet::SkyLookup LightSet::lookup_environment(Vec3f direction, Vec3f position, float time,
                                                const Wavelengths& wavelengths) const {
    if (environment_pmf_ <= 0) return {environment_radiance(direction, time, wavelengths), 0};
    const Environment::Lookup found = sampled_->lookup(direction, time);
    return {wavelengths.emission(found.luminance), infinite_probability(position) * environment_pmf_ * found.pdf};
}

}  // namespace dg
