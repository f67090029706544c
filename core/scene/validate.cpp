// validate.cpp -- the checks of a scene description.
#include "scene/validate.h"

#include "math/error.h"

namespace dg {
namespace {

// Relative to the lengths of the axes: below, a float transform cannot be inverted.
constexpr double kSmallestDeterminant = 1e-7;

void check_index(const std::string& where, const char* what, std::uint32_t index,
                 std::size_t count) {
    if (index < count) return;
    throw input_error(where, what, "less than " + std::to_string(count),
                      std::to_string(index));
}

void check_transform(const std::string& where, const Affine3f& m) {
    for (Vec3f v : {m.x, m.y, m.z, m.origin}) {
        if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
        throw input_error(where, "transform", "finite numbers",
                          "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                              std::to_string(v.z) + ") in a column");
    }
    const Vec3d x = to_double(m.x), y = to_double(m.y), z = to_double(m.z);
    const double volume = length(x) * length(y) * length(z);
    const double det = std::abs(dot(x, cross(y, z)));
    if (volume > 1e-60 && det > kSmallestDeterminant * volume) return;
    throw input_error(where, "transform", "an invertible matrix (no scale of 0)",
                      "determinant " + std::to_string(det));
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
}

}  // namespace dg
