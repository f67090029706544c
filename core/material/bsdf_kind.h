// bsdf_kind.h -- concepts of BSDFs. bsdf.h asserts them for each alternative, transport/media/phase_bsdf.h for phase
// functions.
//
// To add a BSDF:
//   1. core/material/bsdf_x.h: a struct that satisfies BsdfKind. The compiler names what is missing.
//   2. core/material/bsdf.h: the struct becomes an alternative of Bsdf.
//   3. core/material/bsdf_test.cpp: a row. Its checks integrate the density, compare sample() with it (chi-square), and
//      test reciprocity and energy.
//   4. core/material/shade_surfaces.cpp: return it for a surface. A surface with new parameters is a struct in
//      surfaces.h and an alternative of Material's `kind` too (material.h).
// CONTRIBUTING.md names a diff that does all this.
//
// All directions are unit vectors in the world frame that point away from the surface: `wo` to the camera's side of the
// path, `wi` to the light's.
#pragma once
#include <concepts>
#include <optional>

#include "material/bsdf_sample.h"

namespace dg {

/// f |cos wi| for a pair of directions, and the density of sample(). Both exclude delta lobes.
template <typename B>
concept Evaluates = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.evaluate_with_pdf(wo, wi) } -> std::same_as<Evaluation>;
};

/// Samples a direction wi; empty where all light is absorbed. kOneLobe: sample() ignores u_lobe, so that no random
/// number is drawn for it.
template <typename B>
concept Samples = requires(const B& bsdf, Vec3f wo, float u_lobe, Vec2f u) {
    { bsdf.sample(wo, u_lobe, u) } -> std::same_as<std::optional<BsdfSample>>;
    { B::kOneLobe } -> std::convertible_to<bool>;
};

/// is_specular(): all lobes are deltas, so that light sampling cannot find them. diffuse_share(): diffuse fraction of f
/// without delta lobes, 0 to 1, for the effects of shadow catchers.
template <typename B>
concept HasLobes = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.is_specular() } -> std::same_as<bool>;
    { bsdf.diffuse_share(wo, wi) } -> std::convertible_to<float>;
};

/// bounds_volume(): the surface bounds a volume with the medium interior(). False for thin sheets.
template <typename B>
concept HasInterior = requires(const B& bsdf) {
    { bsdf.interior() } -> std::same_as<Interior>;
    { bsdf.bounds_volume() } -> std::same_as<bool>;
};

/// straight_transmittance(): transmittance of a smooth clear surface along the unrefracted ray. At the boundary of a
/// volume, the entry and exit face of a plane slab use the Fresnel reflectance at the outer angle.
/// reversed(): weight of a delta lobe from wi to wo over its weight from wo to wi, without the factor 1 / eta^2.
template <typename B>
concept HasDeltas = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.straight_transmittance(wo) } -> std::convertible_to<Spectrum>;
    { bsdf.reversed(wo, wi) } -> std::convertible_to<float>;
};

/// The parts of evaluate_with_pdf(), for light paths and tests.
template <typename B>
concept EvaluatesApart = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.evaluate(wo, wi) } -> std::convertible_to<Spectrum>;
    { bsdf.pdf(wo, wi) } -> std::convertible_to<float>;
};

/// Scatters a path at a vertex: a BSDF, or a phase function with the interface of a BSDF.
template <typename B>
concept Scatters = Evaluates<B> && Samples<B> && HasLobes<B> && HasInterior<B>;

/// A phase function: rays do not leave the medium where it scatters.
template <typename B>
concept PhaseKind = Scatters<B> && requires { requires B::kInMedium; };

/// A BSDF: a small value type, created at a hit.
template <typename B>
concept BsdfKind = std::copyable<B> && Scatters<B> && !PhaseKind<B> && EvaluatesApart<B> && HasDeltas<B>;

}  // namespace dg
