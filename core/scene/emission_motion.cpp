#include "scene/emission_motion.h"

#include <algorithm>
#include <limits>
#include <span>

#include "light/light_keys.h"
#include "motion/moving_bounds.h"

namespace dg {
namespace {

// Steps per key, where a motion rotates by at most half a turn from key to key, and steps per turn of a spin.
constexpr int kStepsPerKey = 8, kStepsPerTurn = 16;
// Meshes with more steps are bounded as a whole: each triangle gets the bounds of the mesh over all times.
constexpr std::size_t kMostSteps = 512;

/// Poses of the instance, with rotations of less than a right angle between them, and both poses at a jump. If too many
/// would be needed, samples the whole interval and sets `complete` to false.
struct Places {
    std::vector<Placement> list;
    bool complete = true;
};

Places places_of(const InstanceRecord& record) {
    if (!record.changes()) return {{record.still}, true};
    std::vector<double> keys{0, 1};
    for (std::uint32_t i = 1; i + 1 < record.steps; ++i) keys.push_back(double(i) / (record.steps - 1));
    const Motion::Track* track = record.motion ? record.motion->track() : nullptr;
    for (double t : track ? track->times : std::vector<double>())
        if (t > 0 && t < 1) keys.push_back(t);
    std::ranges::sort(keys);
    const double turns = track ? std::abs(track->spin.revolutions_per_second) : 0;
    const double steps = double(kStepsPerKey * keys.size()) + turns * kStepsPerTurn;
    Places places{{}, steps < kMostSteps};
    if (!places.complete) keys = {0, 1};
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const double span = keys[i + 1] - keys[i];
        const int n = kStepsPerKey + (places.complete ? int(turns * span * kStepsPerTurn) : 0);
        for (int k = 0; k < n; ++k)
            places.list.push_back(record.at(float(keys[i] + span * k / n)));
        places.list.push_back(record.at(std::nextafter(float(keys[i + 1]), 0.f)));
    }
    return places;
}

void put(const InstanceRecord& record, const Placement& placement, TriangleLight& light) {
    const auto [a, b, c] = corners_at(record, placement, light.primitive);
    light.a = a, light.b = b, light.c = c;
    light.mirrored = placement.mirrored;
}

void hold(LightBounds& bounds, Vec3d low, Vec3d high) {
    for (int k = 0; k < 3; ++k) {
        bounds.min[k] = std::min(bounds.min[k], float(low[k]));
        bounds.max[k] = std::max(bounds.max[k], float(high[k]));
    }
}

/// Bounds of the mesh over all times and shapes, without an intensity.
LightBounds bounds_of_way(const InstanceRecord& record, const Mesh& mesh) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    LightBounds all;
    all.min = {kInfinity, kInfinity, kInfinity}, all.max = -all.min;
    if (record.motion) {
        const Hull hull(std::span(mesh.positions.begin(), mesh.positions.end()));
        for (const Box& box : moving_bounds(hull, *record.motion).boxes) hold(all, box.min, box.max);
    } else {
        for (Vec3f p : mesh.positions) {
            const Vec3d q = record.still.world_from_local.point(to_double(p));
            hold(all, q, q);
        }
    }
    return all;
}

}  // namespace

bool place(const InstanceRecord& record, TriangleLight& light, float time) {
    if (!record.is_shown(time)) return false;
    if (!record.changes()) return true;
    const Placement now = record.where(time);
    put(record, now, light);
    return now.world_from_local.determinant() != 0;  // a singular instance cannot be hit
}

void bound_moving_triangles(const InstanceRecord& record, const Mesh& mesh,
                            const std::vector<Light>& lights, std::size_t first,
                            LightMotion& motion) {
    if (first == lights.size()) return;
    const Places places = places_of(record);
    const LightBounds way = places.complete ? LightBounds{} : bounds_of_way(record, mesh);
    std::vector<TriangleLight> steps(places.list.size());
    for (std::size_t i = first; i < lights.size(); ++i) {
        const auto& light = std::get<TriangleLight>(lights[i]);
        for (std::size_t k = 0; k < steps.size(); ++k) {
            steps[k] = light;
            put(record, places.list[k], steps[k]);
        }
        LightBounds bounds = bounds_over(steps, light.mean_luminance);
        if (!places.complete) {
            const float intensity = bounds.intensity;
            bounds = way;
            bounds.intensity = intensity;
        }
        motion.triangles[std::uint32_t(i)] = bounds;
    }
}

}  // namespace dg
