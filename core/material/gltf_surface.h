// gltf_surface.h -- evaluates glTF factors and textures at a hit to the parameters of the BSDF.
#pragma once
#include "material/bsdf_gltf.h"
#include "material/material.h"

namespace dg {

/// Factor x texture x vertex colour, clamped to [0, 1].
Rgb base_color(const GltfMaterial& m, const std::vector<Texture>& textures,
               const SurfaceHit& hit);

/// Variance of the slopes of the normal map, per axis, under the hit's footprint.
float slope_variance(const GltfMaterial& m, const std::vector<Texture>& textures,
                     const SurfaceHit& hit);

/// Metallic-roughness or specular-glossiness with transmission, diffuse transmission, volume and dispersion, without
/// layers (gltf_layers.h). Reads hit.slope_variance.
GltfSurface gltf_surface(const GltfMaterial& m, const std::vector<Texture>& textures,
                         const SurfaceHit& hit, const Wavelengths& wavelengths);

SolidOptics solid_optics_of(const GltfMaterial& m, const Wavelengths& wavelengths);

/// Diffuse and specular albedo of the surface, for the `albedo` channel.
Rgb surface_albedo(const GltfMaterial& m, const std::vector<Texture>& textures,
                   const SurfaceHit& hit);

}  // namespace dg
