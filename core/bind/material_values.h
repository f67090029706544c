// material_values.h -- converts materials from Python, given as dicts of fields.
#pragma once
#include <nanobind/nanobind.h>

#include <string>

#include "material/material.h"

namespace dg::bind {

/// A texture slot, as (texture, uv_set, transform) or None.
TextureSlot to_slot(nanobind::handle value);

/// `kind`: diffuse, conductor, dielectric, coated, mix, boundary or gltf. `values`: fields of the kind. `common`:
/// fields of all materials, with the index of the profile. Throws Error for invalid values.
Material to_material(const std::string& name, const std::string& kind, const nanobind::dict& values,
                     const nanobind::dict& common);

}  // namespace dg::bind
