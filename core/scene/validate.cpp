// validate.cpp -- validation of a scene description.
#include "scene/validate.h"

#include "math/error.h"

namespace dg {
namespace {

void check_index(const std::string& where, const char* what, std::uint32_t index,
                 std::size_t count) {
    if (index < count) return;
    throw input_error(where, what, "less than " + std::to_string(count),
                      std::to_string(index));
}

void check_transform(const std::string& where, const Affine3f& m) {
    for (Vec3f v : {m.x, m.y, m.z, m.origin}) {
        if (within_limits(v)) continue;
        throw input_error(where, "transform", "finite numbers below 1e18",
                          "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                              std::to_string(v.z) + ") in a column");
    }
    if (is_invertible(to_double(m))) return;
    throw input_error(where, "transform", "an invertible matrix (no scale of 0, no shear beyond single precision)",
                      "determinant " + std::to_string(to_double(m).determinant()));
}

template <typename T>
void check_times(const std::string& where, const Keyed<T, double>& keys) {
    const auto& t = keys.times;
    if (t.empty() || t.size() != keys.values.size())
        throw input_error(where, "keys", "one value for each time, at least one",
                          std::to_string(t.size()) + " times, " +
                              std::to_string(keys.values.size()) + " values");
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (std::isfinite(t[i]) && (i == 0 || t[i] >= t[i - 1])) continue;
        throw input_error(where, "key " + std::to_string(i) + ": time",
                          "finite times that do not decrease", std::to_string(t[i]) + " s");
    }
}

void check_profile(const std::string& where, std::int32_t profile, const SceneDescription& d) {
    if (profile >= 0) check_index(where, "profile index", std::uint32_t(profile), d.profiles.size());
}

void check_profiles(const SceneDescription& d) {
    for (const Material& m : d.materials) check_profile("material '" + m.name + "'", m.profile, d);
    for (const auto& [i, keys] : d.material_keys)
        for (const Material& m : keys.values) check_profile("keys of material " + std::to_string(i), m.profile, d);
}

/// Parts must precede their mixture, which excludes cycles.
void check_mixtures(const SceneDescription& d) {
    std::vector<int> nested(d.materials.size(), 0);
    const auto check = [&](std::uint32_t i, const Material& m) {
        const auto* mix = std::get_if<MixMaterial>(&m.kind);
        if (!mix) return;
        const std::string where = "material '" + d.materials[i].name + "'";
        for (const auto& [what, part] : {std::pair{"first", mix->first}, {"second", mix->second}}) {
            check_index(where, what, part, i);
            nested[i] = std::max(nested[i], nested[part] + 1);
            if (emits(d.materials[part]))
                throw input_error(where, what, "a material that emits nothing", "'" + d.materials[part].name + "'");
        }
        if (nested[i] > MixMaterial::kMostNested)
            throw input_error(where, "mixtures within it", "at most " + std::to_string(MixMaterial::kMostNested),
                              std::to_string(nested[i]));
    };
    for (std::uint32_t i = 0; i < d.materials.size(); ++i) check(i, d.materials[i]);
}

void validate_keys(const SceneDescription& d) {
    for (const auto& [i, keys] : d.material_keys) {
        check_index("keys of material " + std::to_string(i), "index", i, d.materials.size());
        check_times("material '" + d.materials[i].name + "'", keys);
        validate(keys.values, d.textures);
    }
    for (const auto& [i, keys] : d.light_keys) {
        const std::string where = "light " + std::to_string(i);
        check_index("keys of " + where, "index", i, d.lights.size());
        check_times(where, keys);
        check_keys(keys.values, where);
    }
    if (d.environment_keys) check_times("environment", *d.environment_keys);
}

}  // namespace

void validate(const SceneDescription& d) {
    for (const Mesh& mesh : d.meshes) mesh.validate();
    for (const Texture& texture : d.textures) texture.validate();
    for (const Material& material : d.materials) validate(material, d.textures);
    for (std::size_t i = 0; i < d.instances.size(); ++i) {
        const Instance& instance = d.instances[i];
        const std::string where =
            "instance " + std::to_string(i) + " '" + instance.name + "'";
        check_index(where, "mesh index", instance.mesh, d.meshes.size());
        check_index(where, "material index", instance.material, d.materials.size());
        if (!instance.motion) check_transform(where, instance.world_from_local);
    }
    check_mixtures(d);
    check_profiles(d);
    validate(d.media, d.materials.size());
    validate_keys(d);
}

}  // namespace dg
