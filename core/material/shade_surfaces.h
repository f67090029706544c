// shade_surfaces.h -- the kinds of surfaces.h at a hit, for this room's own files. hit.ns is mapped already.
#pragma once
#include "material/material_read.h"

namespace dg {

Bsdf shade_kind(const DiffuseMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths);
Bsdf shade_kind(const ConductorMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths);
Bsdf shade_kind(const DielectricMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths);
Bsdf shade_kind(const CoatedMaterial& m, const Textures& textures, const SurfaceHit& hit,
                const Wavelengths& wavelengths);

/// For the albedo AOV. Of metals the reflectance at normal incidence, at one wavelength for each of red, green, blue.
Rgb albedo_of(const DiffuseMaterial& m, const Textures& textures, const SurfaceHit& hit);
Rgb albedo_of(const ConductorMaterial& m, const Textures& textures, const SurfaceHit& hit);
Rgb albedo_of(const DielectricMaterial& m, const Textures& textures, const SurfaceHit& hit);
Rgb albedo_of(const CoatedMaterial& m, const Textures& textures, const SurfaceHit& hit);

}  // namespace dg
