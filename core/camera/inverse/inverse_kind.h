// inverse_kind.h -- interface of a kind of camera seen from the scene: chief rays, pixel cones, and
// sampling of the lens. All follow from chief_direction(), film_point() and opening(); exact lenses
// measure them instead.
#pragma once
#include "camera/inverse/chief.h"
#include "camera/inverse/pixel_cone.h"
#include "camera/inverse/pupil_view.h"

namespace dg {

template <typename L>
concept InverseKind = requires(const L& lens, const Sensor& sensor) {
    { ChiefRays::of(lens) } -> std::same_as<ChiefRays>;
    { PixelCone::of(lens, sensor) } -> std::same_as<PixelCone>;
    { PupilView::of(lens) } -> std::same_as<PupilView>;
};

template <typename Kinds>
inline constexpr bool kInverseKinds = false;
template <typename... L>
inline constexpr bool kInverseKinds<std::variant<L...>> = (InverseKind<L> && ...);
static_assert(kInverseKinds<LensKind>);

}  // namespace dg
