#include "scene/changes.h"

#include "scene/scene.h"

namespace dg {
namespace {

/// Calls a function with the index and the clipped keys of each animated T.
template <typename T, typename What>
void cut(std::map<std::uint32_t, Keyed<T, double>>& all, const TimeInterval& interval, What what) {
    for (const auto& [i, keys] : all) what(i, over(keys, interval.open, interval.close));
    all.clear();
}

}  // namespace

Changes take_changes(SceneDescription& d) {
    Changes changes;
    cut(d.material_keys, d.interval, [&](std::uint32_t i, Keyed<Material> keys) {
        const std::string name = d.materials[i].name;
        d.materials[i] = keys.values[0];
        d.materials[i].name = name;
        if (!keys.moves()) return;
        changes.materials.resize(d.materials.size());
        MaterialRange range = range_of(keys);
        changes.materials[i].reset(new MaterialChange{std::move(keys), std::move(range)});
    });
    cut(d.light_keys, d.interval, [&](std::uint32_t i, Keyed<Light> keys) {
        d.lights[i] = keys.values[0];
        if (keys.moves()) changes.lights[i] = std::move(keys);
    });
    if (d.environment && d.environment_keys)
        d.environment = d.environment->posed(
            over(*d.environment_keys, d.interval.open, d.interval.close));
    d.environment_keys.reset();
    return changes;
}

}  // namespace dg
