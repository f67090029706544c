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
    static PupilView of(const Pinhole& lens);
    static PupilView of(const ThinLens& lens);
    static PupilView of(const ThickLens& lens);
    static PupilView of(const ExactLens& lens);
    static PupilView of(const Projection& lens);

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
    struct Hole {
        bool all_around = false;   // what lies beside it and behind is seen, too
    };
    /// An iris that faces each chief ray, within a ball of that radius (m) about the origin.
    struct Turning {
        double radius;
        bool all_around;
    };
    /// A flat iris. Rays start on the plane z = start of its frame.
    struct Disc {
        Affine3d frame;  // camera from iris, m
        double radius;   // of the unit of the shape, m; negative: an image turned by 180
                         // degrees
        double start;
        std::shared_ptr<const Iris> iris;
    };
    using Kind = std::variant<Hole, Turning, Disc, std::shared_ptr<const PupilShape>>;
    explicit PupilView(Kind kind) : kind_(std::move(kind)) {}
    static Disc disc_of(const ThinLens::Numbers& numbers,
                        std::shared_ptr<const Iris> iris);

    static Turning turning(const Projection::Numbers& numbers, const Projection& shape);

    Kind kind_;
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
    bool evenly_ = false;       // thin lenses and projections change evenly from one to the next
    std::vector<std::unique_ptr<State>> states_;
};

}  // namespace dg
