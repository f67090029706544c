// camera_kind.h -- what a kind of camera can do by itself; camera.h asserts it of each. What the scene sees of it is
// inverse/inverse_kind.h: that follows for kinds that have film_point() and opening().
#pragma once
#include <concepts>
#include <optional>
#include <span>
#include <vector>

#include "camera/camera_sample.h"
#include "camera/opening.h"

namespace dg {

using NumberGroups = std::vector<std::vector<double>>;

/// Fills rays[i] for samples[i]; weight 0: stopped.
template <typename L>
concept Generates = requires(const L& lens, std::span<const CameraSample> samples, std::span<CameraRay> rays) {
    lens.generate(samples, rays);
};

/// Says where scene rays meet the film; a kind that disperses light asks for their wavelengths, nm.
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

/// The view direction of a film point (mm, upright): unit, camera frame; nothing where the kind sees nothing.
template <typename L>
concept HasChief = requires(const L& lens, Vec2d film_mm) {
    { lens.chief_direction(film_mm) } -> std::convertible_to<std::optional<Vec3d>>;
};

/// The film point that sees a point (p, 1), m, or a direction (p, 0), of the camera frame; nothing if none does. All chief
/// rays go through one point: the origin, or (0, 0, pupil_offset_m()).
template <typename L>
concept HasFilmPoint = requires(const L& lens, Vec3d p, double w) {
    { lens.film_point(p, w) } -> std::same_as<std::optional<Vec2d>>;
};

/// The opening is a point or an iris; of an iris the kind has its shape, `iris` or iris().
template <typename L>
concept HasOpening = requires(const L& lens) {
    { lens.opening() } -> std::same_as<Opening>;
};

/// Changes while the shutter is open are numbers, which lie between those of the neighbouring keys. groups() has them
/// for who chooses the keys: numbers of one unit together.
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

/// Changes are set up as states, each in the frame of the middle one; a sample takes the nearest in time.
template <typename L>
concept ChangesInSteps = requires(const L& lens) {
    { lens.in_the_body_of(lens) } -> std::same_as<L>;
};

template <typename L>
concept CameraKind = std::copyable<L> && Generates<L> && Reprojects<L> && HasChief<L> &&
                     (ChangesEvenly<L> != ChangesInSteps<L>);

}  // namespace dg
