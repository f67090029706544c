#include "light/emitter_points.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "light/emitter.h"

namespace dg {
namespace {

constexpr double kOwnShare = 0.01;    // share of all light above which a light is a separate source
constexpr float kOneLamp = 0.07f;     // rad: angular size up to which the triangles of an instance form one source
constexpr double kLeastShare = 0.02;  // fraction of the mean: lower bound of a light's weight in its source
constexpr float kPartAngle = 0.4f;    // rad: angular size above which a light is divided
constexpr int kMostAcross = 6;        // limit of parts along each axis of a light
constexpr double kPartShare = 0.005;  // least share of all light per part
constexpr int kMostHot = 48;          // parts of the bright sky
constexpr int kAcross = 16, kDown = 8;   // tiles of the remaining sky

/// Index of a direction's square on a cube map with 4 x 4 squares per side.
int square_of(Vec3f d) {
    const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    const int axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    const float main = d[axis], u = d[(axis + 1) % 3] / std::abs(main), v = d[(axis + 2) % 3] / std::abs(main);
    const auto step = [](float x) { return std::clamp(int((x + 1) * 2), 0, 3); };
    return ((axis * 2 + (main > 0)) * 4 + step(u)) * 4 + step(v);
}

/// End of the consecutive triangle lights of an instance, or of a single light of another kind.
std::size_t end_of_instance(std::span<const Light> lights, std::size_t first) {
    const auto instance = [&](std::size_t i) {
        const auto* triangle = std::get_if<TriangleLight>(&lights[i]);
        return triangle ? std::optional(triangle->instance) : std::nullopt;
    };
    std::size_t end = first + 1;
    while (end < lights.size() && instance(first) && instance(end) == instance(first)) ++end;
    return end;
}

/// Largest angular size of bounds from the views, rad; pi from inside.
float angle_of(const LightBounds& b, std::span<const ViewCone> views) {
    const float radius = 0.5f * length(b.max - b.min);
    float angle = 0;
    for (const ViewCone& view : views) {
        const float distance = length((b.min + b.max) * 0.5f - view.from.eye);
        angle = std::max(angle, radius < distance ? 2 * asin(radius / distance) : kPi);
    }
    return angle;
}

/// Illuminance per unit area of an emitter, from position and orientation.
double brought_by(const std::optional<EmitterPoint>& point, const Viewpoint& view) {
    if (!point) return 0;
    const Vec3f to = view.eye - point->point.position;
    const double d2 = std::max(length_squared(to), view.radius * view.radius);
    return d2 > 0 ? std::abs(dot(to, point->point.normal)) / (d2 * std::sqrt(d2)) : 0;
}

/// Triangle lights of an instance.
struct Lamp {
    std::vector<std::int32_t> lights;
    LightBounds bounds{};
    double strength = 0;

    void add(std::int32_t light, const LightBounds& b, double brings) {
        bounds = lights.empty() ? b : merge(bounds, b);
        lights.push_back(light), strength += brings;
    }
};

}  // namespace

EmitterPoints::EmitterPoints(const LightSet& lights, std::span<const ViewCone> views) : lights_(&lights) {
    add_lights(views);
    add_sky(views);
}

void EmitterPoints::add(Highlights highlights) {
    highlights_ = std::move(highlights);
    for (int i = 0; i < highlights_.count(); ++i)
        sources_.push_back({.strength = highlights_.illuminance(i), .highlight = i});
}

void EmitterPoints::add_lights(std::span<const ViewCone> views) {
    const std::size_t count = lights_->lights().size();
    std::vector<double> strength(count);
    std::map<int, std::vector<std::int32_t>> groups;
    for (std::size_t i = 0; i < count; ++i) {
        const LightBounds b = lights_->bounds_of(i);
        strength[i] = lights_->infinite_weight(i);
        for (const ViewCone& view : views)
            strength[i] += illuminance_estimate(b, lights_->moves(i), view) / double(views.size());
    }
    const double all = std::accumulate(strength.begin(), strength.end(), 0.0);
    const std::vector<bool> taken = add_lamps(views, strength, all);
    for (std::size_t i = 0; i < count; ++i) {
        if (!(strength[i] > 0) || taken[i]) continue;
        const LightBounds b = lights_->bounds_of(i);
        if (strength[i] > kOwnShare * all || lights_->infinite_weight(i) > 0)
            add_parts(std::int32_t(i), strength, all, views);
        else
            groups[square_of((b.min + b.max) * 0.5f - views.front().from.eye)].push_back(std::int32_t(i));
    }
    for (auto& [square, members] : groups) add_source(std::move(members), strength);
}

/// A lamp of many triangles with a small angular size is a single source, like a sphere light.
std::vector<bool> EmitterPoints::add_lamps(std::span<const ViewCone> views, const std::vector<double>& strength,
                                           double all) {
    std::vector<bool> taken(strength.size());
    for (std::size_t first = 0, next; first < strength.size(); first = next) {
        next = end_of_instance(lights_->lights(), first);
        if (next - first < 2) continue;
        Lamp lamp;
        for (std::size_t i = first; i < next; ++i)
            if (strength[i] > 0) lamp.add(std::int32_t(i), lights_->bounds_of(i), strength[i]);
        if (!(lamp.strength > kOwnShare * all) || !(angle_of(lamp.bounds, views) < kOneLamp)) continue;
        for (const std::int32_t i : lamp.lights) taken[std::size_t(i)] = true;
        add_source(std::move(lamp.lights), strength);
    }
    return taken;
}

void EmitterPoints::add_source(std::vector<std::int32_t> lights, const std::vector<double>& strength) {
    Source source;
    std::vector<double> weights;
    for (const std::int32_t i : lights) weights.push_back(strength[i]), source.strength += strength[i];
    for (double& w : weights) w = std::max(w, kLeastShare * source.strength / double(weights.size()));
    source.choice = DiscreteDistribution(std::span<const double>(weights));
    source.lights = std::move(lights);
    sources_.push_back(std::move(source));
}

/// Subdivision of the random numbers that choose a point on a light.
std::vector<EmitterPoints::Part> EmitterPoints::parts_of(std::int32_t light, double share,
                                                         std::span<const ViewCone> views) const {
    if (lights_->infinite_weight(light) > 0) return {Part{}};
    const float angle = angle_of(lights_->bounds_of(light), views);
    const int most = std::clamp(int(std::sqrt(share / kPartShare)), 1, kMostAcross);
    const int across = std::clamp(int(std::ceil(angle / kPartAngle)), 1, most);
    const float side = 1 / float(across);
    std::vector<Part> parts;
    for (int y = 0; y < across; ++y)
        for (int x = 0; x < across; ++x) parts.push_back({{float(x) * side, float(y) * side}, side});
    return parts;
}

/// Divides a large light: each film point sees a ghost of a different small part, which rays to the whole light seldom
/// hit.
void EmitterPoints::add_parts(std::int32_t light, const std::vector<double>& strength, double all,
                              std::span<const ViewCone> views) {
    add_source({light}, strength);
    const std::vector<Part> parts = parts_of(light, strength[std::size_t(light)] / all, views);
    if (parts.size() == 1) return;
    const Source whole = std::move(sources_.back());
    sources_.pop_back();
    const ViewCone& view = views.front();
    std::vector<double> brings;
    for (const Part& part : parts)
        brings.push_back(brought_by(sample_light(light, part.at({0.5f, 0.5f}), view.time, view.from), view.from));
    const double sum = std::accumulate(brings.begin(), brings.end(), 0.0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double share = sum > 0 ? brings[i] / sum : 1 / double(parts.size());
        sources_.push_back(whole);
        sources_.back().part = parts[i];
        sources_.back().strength *= std::max(share, kLeastShare / double(parts.size()));
    }
}

/// Adds bright spots with samples by luminance, and uniform tiles for the remaining sky.
void EmitterPoints::add_sky(std::span<const ViewCone> views) {
    if (!lights_->has_environment()) return;
    const Environment& sky = *lights_->environment();
    hot_ = HotSky(sky, views);
    hot_parts_ = hot_.parts(kMostHot);
    for (std::size_t i = 0; i < hot_parts_.size(); ++i)
        sources_.push_back({.strength = hot_parts_[i].illuminance(), .hot = int(i)});
    for (const DirectionTile& tile : direction_tiles(kAcross, kDown)) {
        double sum = 0;
        for (int i = 0; i < 16; ++i) {
            const Vec2f u{(float(i % 4) + 0.5f) / 4, (float(i / 4) + 0.5f) / 4};
            if (const auto p = sample_tile(tile, u, views.front().time))
                sum += luminance(sky.luminance(p->point.position, views.front().time));
        }
        // A tile with dark samples may contain light elsewhere.
        const double mean = std::max(sum / 16, 1e-3 * sky.mean_luminance());
        if (mean > 0) sources_.push_back({.strength = mean * tile.solid_angle(), .tile = tile});
    }
}

bool EmitterPoints::has_size(int source) const {
    const Source& s = sources_[source];
    if (s.hot >= 0) return true;
    return !s.lights.empty() && std::ranges::all_of(s.lights, [&](std::int32_t i) {
        const Light& light = lights_->lights()[i];
        return std::holds_alternative<TriangleLight>(light) || std::holds_alternative<SphereLight>(light);
    });
}

std::optional<EmitterPoint> EmitterPoints::sample(int which, float u_select, Vec2f u, float time,
                                               const Viewpoint& view) const {
    const Source& source = sources_[which];
    if (source.highlight >= 0) return highlights_.sample(source.highlight, u, time);
    if (source.tile) return sample_tile(*source.tile, u, time);
    if (source.hot >= 0) {
        const Environment::Sample s = hot_parts_[source.hot].sample(u, time);
        if (!(s.pdf > 0)) return std::nullopt;
        return EmitterPoint{{.position = s.direction, .pdf = s.pdf}, true};
    }
    const DiscreteSample choice = source.choice.sample(u_select);
    auto point = sample_light(source.lights[choice.index], source.part.at(u), time, view);
    if (!point || !(point->point.pdf > 0)) return std::nullopt;
    point->point.pdf *= choice.pmf / (source.part.side * source.part.side);
    return point;
}

std::optional<EmitterPoint> EmitterPoints::sample_light(std::int32_t light, Vec2f u, float time,
                                                     const Viewpoint& view) const {
    const Light& kind = lights_->lights()[light];
    std::optional<EmissionPoint> point;
    EmitterPoint from;
    if (std::holds_alternative<TriangleLight>(kind)) {
        if (const auto now = lights_->triangle_at(light, time)) point = point_on(TriangleSampler(*now), u);
    } else if (std::holds_alternative<SphereLight>(kind)) {
        point = point_on(lights_->sphere_light_at(light, time).shape, u, view);
    } else {
        point = EmissionPoint{.pdf = 1};
        from.delta = true;
        const Light now = lights_->light_at(light, time);
        if (const auto* sun = std::get_if<DirectionalLight>(&now))
            point->position = toward_disc(*sun, u), from.at_infinity = true;
        else if (const auto* spot = std::get_if<SpotLight>(&now))
            point->position = spot->position;
        else
            point->position = std::get<PointLight>(now).position;
    }
    if (!point) return std::nullopt;
    from.point = *point;
    from.point.light = light;
    return from;
}

/// Uniform directions without bright spots, which are separate sources.
std::optional<EmitterPoint> EmitterPoints::sample_tile(const DirectionTile& tile, Vec2f u, float time) const {
    const Vec3f d = tile.at(u);
    if (!hot_.empty() && hot_.pdf(d, time) > 0) return std::nullopt;
    return EmitterPoint{{.position = d, .pdf = 1 / tile.solid_angle()}, true};
}

Rgb EmitterPoints::delta_value(const EmitterPoint& from, Vec3f to, float time) const {
    const Light light = lights_->light_at(from.point.light, time);
    const auto at = std::visit(
        [&](const auto& kind) { return sample_emitter(kind, Vec2f{}, to); }, light);
    if (!at) return {0, 0, 0};
    if (from.at_infinity) return at->value;
    return at->value * lights_->shaped(light, -at->wi) * (at->distance * at->distance);
}

}  // namespace dg
