// media.h -- which medium is where: within closed meshes, by their material, and around them all.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "medium/medium.h"

namespace dg {

/// Media on both sides of a material's surfaces; indices, -1: inside none, outside the fog.
struct MediaOfMaterial {
    std::int32_t inside = -1, outside = -1;
    bool invisible = false;   // nothing but media changes there
};

/// Media of a scene description.
struct SceneMedia {
    std::vector<std::shared_ptr<const Medium>> all;
    std::map<std::uint32_t, MediaOfMaterial> of_material;   // by index; surfaces of the others bound none
    std::int32_t fog = -1;                                  // of the world outside; -1: none

    bool empty() const { return of_material.empty() && fog < 0; }
};

/// Throws Error for an index without a medium or a material.
void validate(const SceneMedia& media, std::size_t materials);

/// The same for one instance.
struct MediaOfInstance {
    const Medium *inside = nullptr, *outside = nullptr;
    bool bounds = false;      // another medium may begin there
    bool invisible = false;
};

}  // namespace dg
