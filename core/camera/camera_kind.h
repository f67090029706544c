// camera_kind.h -- what a kind of camera can do by itself; camera.h asserts it of each. What the scene sees of it is
// inverse/inverse_kind.h.
#pragma once
#include <concepts>
#include <optional>
#include <span>

#include "camera/camera_sample.h"

namespace dg {

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

/// Changes while the shutter is open are numbers, which lie between those of the neighbouring keys.
template <typename L>
concept ChangesEvenly = requires(const L& lens, const typename L::Numbers& now, std::span<const CameraSample> samples,
                                 std::span<CameraRay> rays, std::span<Reprojection> out) {
    { lens.numbers() } -> std::same_as<typename L::Numbers>;
    { blend(now, now, 0.5) } -> std::same_as<typename L::Numbers>;
    lens.generate(now, samples, rays);
    lens.reproject(now, rays, out);
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
