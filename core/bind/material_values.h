// material_values.h -- materials from Python: dicts of the fields of its classes, by name.
#pragma once
#include <nanobind/nanobind.h>

#include <string>

#include "material/material.h"

namespace dg::bind {

/// A slot as (texture, uv_set, transform) or None.
TextureSlot to_slot(nanobind::handle value);

/// `kind`: diffuse, conductor, dielectric, coated, mix, boundary or gltf. `values`: its fields. `common`: those of the
/// material, with the index of its profile. Throws Error.
Material to_material(const std::string& name, const std::string& kind, const nanobind::dict& values,
                     const nanobind::dict& common);

}  // namespace dg::bind
