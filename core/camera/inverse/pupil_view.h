// pupil_view.h -- importance sampling of the lens from a point of the scene.
//
// A point (p, 1) of the camera frame (m), or a direction at infinity (p, 0), samples a ray toward a
// region that tightly bounds all its passing rays. The density has a closed form and can be
// evaluated for any ray through the point, so camera and light sampling can be combined by MIS.
// reproject() (camera.h) decides whether the ray passes. Sampling does not depend on wavelength.
//
// Pinholes and projections without an iris: a lens of measure one. Thin lens: its iris. Thick lens:
// the entrance pupil, image of the iris. Exact lens: the region of passing camera rays of all
// wavelengths on the entrance pupil, iris fully open (pupil_shape.h).
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "camera/camera.h"

namespace dg {

class PupilShape;

class PupilView {
  public:
    explicit PupilView(const LensKind& lens);
    template <HasOpening L>
    static PupilView of(const L& lens) {
        return PupilView(lens.opening(), iris_of(lens));
    }
    static PupilView of(const ExactLens& lens);

    struct Sample {
        Vec3f origin;  // origin of camera rays: on the lens, or its first surface
        Vec3f direction;  // unit, from the lens to the point
        float pdf;        // see pdf()
    };
    /// Empty if the point does not see the lens.
    std::optional<Sample> sample(Vec3d p, double w, Vec2f u) const;

    /// Density of a ray through the point: per sr at the point, or (w = 0) per m2 across the ray; 0
    /// outside the sampling region. Pinhole: 1 across the ray.
    float pdf(Vec3d p, double w, const Ray& ray) const;

  private:
    friend class PupilViewOverTime;
    using Shape = std::shared_ptr<const Iris>;
    PupilView(const Opening& opening, Shape iris) : opening_(opening), iris_(std::move(iris)) {}
    explicit PupilView(std::shared_ptr<const PupilShape> pupil) : pupil_(std::move(pupil)) {}
    /// Shape of the iris; null for kinds without an iris.
    template <typename L>
    static Shape iris_of(const L& lens) {
        if constexpr (requires { lens.iris(); })
            return std::make_shared<const Iris>(lens.iris());
        else if constexpr (requires { lens.iris; })
            return std::make_shared<const Iris>(lens.iris);
        else
            return nullptr;
    }

    Opening opening_;
    Shape iris_;
    std::shared_ptr<const PupilShape> pupil_;   // exact lenses: replaces opening_ and iris_
};

/// Lens sampling for a camera with a lens that changes over time: uses the lens at the ray's time.
class PupilViewOverTime {
  public:
    explicit PupilViewOverTime(const Camera& camera);

    std::optional<PupilView::Sample> sample(Vec3d p, double w, Vec2f u, float time) const;
    /// Density at the ray's time.
    float pdf(Vec3d p, double w, const Ray& ray) const;

  private:
    template <typename Use>
    decltype(auto) with_lens(float time, const Use& use) const;

    /// Created on first use: long exposures may never need some states.
    struct State {
        LensKind lens;
        std::once_flag once;
        std::optional<PupilView> view;
    };
    const PupilView& view(std::size_t state) const;

    std::vector<float> times_;  // empty: constant
    std::vector<std::unique_ptr<State>> states_;
};

}  // namespace dg
