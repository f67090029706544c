// bsdf_kind.h -- what a BSDF provides. bsdf.h asserts it of each alternative, transport/phase_bsdf.h of the phase
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

/// f |cos wi| for a pair of directions, with the density of sample(). Delta lobes count in neither.
template <typename B>
concept Evaluates = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.evaluate_with_pdf(wo, wi) } -> std::same_as<Evaluation>;
};

/// Draws a direction wi; nothing where all light is absorbed. kOneLobe: sample() ignores u_lobe, which then costs no
/// random number.
template <typename B>
concept Samples = requires(const B& bsdf, Vec3f wo, float u_lobe, Vec2f u) {
    { bsdf.sample(wo, u_lobe, u) } -> std::same_as<std::optional<BsdfSample>>;
    { B::kOneLobe } -> std::convertible_to<bool>;
};

/// is_specular(): all lobes are deltas, so that light sampling cannot find them. diffuse_share(): part of f without
/// deltas that is diffuse, 0 to 1; effects of shadow catchers need it.
template <typename B>
concept HasLobes = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.is_specular() } -> std::same_as<bool>;
    { bsdf.diffuse_share(wo, wi) } -> std::convertible_to<float>;
};

/// bounds_volume(): behind the surface lies another medium, interior(). A thin sheet bounds none.
template <typename B>
concept HasInterior = requires(const B& bsdf) {
    { bsdf.interior() } -> std::same_as<Interior>;
    { bsdf.bounds_volume() } -> std::same_as<bool>;
};

/// straight_transmittance(): transmittance of a smooth clear surface along the unrefracted ray. At the boundary of a
/// volume, both faces of a plane slab use the Fresnel reflectance of the angle outside.
/// reversed(): weight of a delta lobe from wi to wo over its weight from wo to wi, without the factor 1 / eta^2.
template <typename B>
concept HasDeltas = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.straight_transmittance(wo) } -> std::convertible_to<Spectrum>;
    { bsdf.reversed(wo, wi) } -> std::convertible_to<float>;
};

/// The halves of evaluate_with_pdf(), for light paths and for tests.
template <typename B>
concept EvaluatesApart = requires(const B& bsdf, Vec3f wo, Vec3f wi) {
    { bsdf.evaluate(wo, wi) } -> std::convertible_to<Spectrum>;
    { bsdf.pdf(wo, wi) } -> std::convertible_to<float>;
};

/// Scatters a path at a vertex: a BSDF, or a phase function in the form of one.
template <typename B>
concept Scatters = Evaluates<B> && Samples<B> && HasLobes<B> && HasInterior<B>;

/// A phase function: it scatters within a medium, so that a ray leaves no medium there.
template <typename B>
concept PhaseKind = Scatters<B> && requires { requires B::kInMedium; };

/// A BSDF: a small value that is made at a hit and copied.
template <typename B>
concept BsdfKind = std::copyable<B> && Scatters<B> && !PhaseKind<B> && EvaluatesApart<B> && HasDeltas<B>;

}  // namespace dg
