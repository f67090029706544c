// camera_kind.h -- interface of a kind of camera as concepts, which camera.h asserts for each kind.
// inverse/inverse_kind.h covers the inverse direction; it follows from film_point() and opening().
#pragma once
#include <concepts>
#include <optional>
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "camera/opening.h"

namespace dg {

using NumberGroups = std::vector<std::vector<double>>;

/// Generates rays[i] for samples[i]; weight 0: clipped.
template <typename L>
concept Generates = requires(const L& lens, std::span<const CameraSample> samples, std::span<CameraRay> rays) {
    lens.generate(samples, rays);
};

/// Traces scene rays to the film; dispersive kinds also take their wavelengths in nm.
template <typename L>
concept ReprojectsByWavelength = requires(const L& lens, std::span<const CameraRay> rays,
                                          std::span<const float> nm, std::span<Reprojection> out) {
    lens.reproject(rays, nm, out);
};
template <typename L>
concept Reprojects = ReprojectsByWavelength<L> ||
                     requires(const L& lens, std::span<const CameraRay> rays, std::span<Reprojection> out) {
                         lens.reproject(rays, out);
                     };

/// View direction of a film point (mm, upright): unit vector in the camera frame; empty outside the
/// field of view.
template <typename L>
concept HasChief = requires(const L& lens, Vec2d film_mm) {
    { lens.chief_direction(film_mm) } -> std::convertible_to<std::optional<Vec3d>>;
};

/// Film point that sees a point (p, 1) in m, or a direction (p, 0), in the camera frame; empty if
/// none does. All chief rays pass through one point: the origin, or (0, 0, pupil_offset_m()).
template <typename L>
concept HasFilmPoint = requires(const L& lens, Vec3d p, double w) {
    { lens.film_point(p, w) } -> std::same_as<std::optional<Vec2d>>;
};

/// Opening of the lens, a point or an iris; a kind with an iris also provides its shape, as `iris`
/// or iris().
template <typename L>
concept HasOpening = requires(const L& lens) {
    { lens.opening() } -> std::same_as<Opening>;
};

/// The lens changes over time by linear interpolation of numbers between keys. groups() lists the
/// numbers by common unit, for the placement of keys.
template <typename L>
concept ChangesEvenly = HasFilmPoint<L> && HasOpening<L> &&
                        requires(L lens, const typename L::Numbers& now, std::span<const CameraSample> samples,
                                 std::span<CameraRay> rays, std::span<Reprojection> out) {
                            { lens.numbers() } -> std::same_as<typename L::Numbers>;
                            { blend(now, now, 0.5) } -> std::same_as<typename L::Numbers>;
                            { now.groups() } -> std::same_as<NumberGroups>;
                            lens.set(now);
                            lens.generate(now, samples, rays);
                            lens.reproject(now, rays, out);
                            { lens.opening(now) } -> std::same_as<Opening>;
                        };

/// The lens changes over time by precomputed states in the frame of the middle state; a sample uses
/// the nearest.
template <typename L>
concept ChangesInSteps = requires(const L& lens) {
    { lens.in_the_body_of(lens) } -> std::same_as<L>;
};

template <typename L>
concept CameraKind = std::copyable<L> && Generates<L> && Reprojects<L> && HasChief<L> &&
                     (ChangesEvenly<L> != ChangesInSteps<L>);

}  // namespace dg
