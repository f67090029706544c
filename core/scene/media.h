// media.h -- assignment of media: inside closed meshes by material, and around the scene.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "medium/medium.h"

namespace dg {

/// Media on both sides of a material's surfaces, as indices; -1: none inside, the fog outside.
struct MediaOfMaterial {
    std::int32_t inside = -1, outside = -1;
    bool invisible = false;   // the surface only separates media
};

/// Media of a scene description.
struct SceneMedia {
    std::vector<std::shared_ptr<const Medium>> all;
    std::map<std::uint32_t, MediaOfMaterial> of_material;   // by index; other materials do not bound media
    std::int32_t fog = -1;                                  // around the scene; -1: none

    bool empty() const { return of_material.empty() && fog < 0; }
};

/// Throws Error for an invalid index of a medium or a material.
void validate(const SceneMedia& media, std::size_t materials);

/// Media on both sides of an instance's surfaces.
struct MediaOfInstance {
    const Medium *inside = nullptr, *outside = nullptr;
    bool bounds = false;      // its surfaces bound a medium
    bool invisible = false;
};

}  // namespace dg
