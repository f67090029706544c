// pupil_view.h -- the lens as a point of the scene sees it: where light must aim to come
// through.
//
// A point (p, 1) of the camera frame (m), or a direction at infinity (p, 0), draws a ray
// toward a region that holds every point at which its light passes the lens, and little
// else. The density is known in closed form and can be asked again for any ray of the
// point, so camera and light can weigh one ray alike. What passes is not the region's
// affair: reproject() (camera.h) traces the ray. No ray depends on a wavelength.
//
// Pinholes and projections without an iris are a lens of measure one. Thin lens: its iris; thick: the iris's image, the
// entrance pupil. Exact: what camera rays of all wavelengths leave at the entrance pupil,
// iris fully open (pupil_shape.h).
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
        Vec3f origin;  // where rays of the camera start: the lens, or its first surface
        Vec3f direction;  // unit, from the lens to the point
        float pdf;        // see below
    };
    /// Nothing where the point sees no lens.
    std::optional<Sample> sample(Vec3d p, double w, Vec2f u) const;

    /// Density of a ray through the point: per sr at the point, or (w = 0) per m2 across
    /// the ray; 0: it is never drawn. Pinhole: 1 across the ray.
    float pdf(Vec3d p, double w, const Ray& ray) const;

  private:
    friend class PupilViewOverTime;
    using Shape = std::shared_ptr<const Iris>;
    PupilView(const Opening& opening, Shape iris) : opening_(opening), iris_(std::move(iris)) {}
    explicit PupilView(std::shared_ptr<const PupilShape> pupil) : pupil_(std::move(pupil)) {}
    /// Shape of the iris; none without one.
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
    std::shared_ptr<const PupilShape> pupil_;   // exact lenses, instead
};

/// Those of a camera whose lens changes while the shutter is open: of the lens that draws
/// at each time.
class PupilViewOverTime {
  public:
    explicit PupilViewOverTime(const Camera& camera);

    std::optional<PupilView::Sample> sample(Vec3d p, double w, Vec2f u, float time) const;
    /// At the ray's time.
    float pdf(Vec3d p, double w, const Ray& ray) const;

  private:
    template <typename Use>
    decltype(auto) with_lens(float time, const Use& use) const;

    /// Made when it is first asked for: few of a long exposure's states may be.
    struct State {
        LensKind lens;
        std::once_flag once;
        std::optional<PupilView> view;
    };
    const PupilView& view(std::size_t state) const;

    std::vector<float> times_;  // empty: one state
    std::vector<std::unique_ptr<State>> states_;
};

}  // namespace dg
