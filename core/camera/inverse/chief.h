// chief.h -- the chief rays of a camera and their inverse: which film point sees a point
// of the scene.
//
// The chief ray of a film point is the mean of the rays that pass: it meets every plane
// across it in the middle of what the film point sees of that plane. So it goes through
// the point in focus exactly, and through the middle of the blur elsewhere; mounts that
// cut the pupil move it, but never darken it. Ideal lenses: through the centre of the
// lens, or of a thick one's pupils. Exact lenses: the mean at the design wavelength, with
// the iris turned to all sides, so that it depends on the distance from the axis alone;
// of tilted, decentred and anamorphic ones it is tabulated over the film, iris as it is.
#pragma once
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "camera/inverse/chief_grid.h"

namespace dg {

struct ChiefRay {
    Vec3d origin,
        direction;  // camera frame, m; unit; from where the lens's own rays start
};

class ChiefRays {
  public:
    using Lit = ChiefGrid::Lit;

    /// Throws Error if no light passes an exact lens on its axis.
    explicit ChiefRays(const LensKind& lens);
    template <HasFilmPoint L>
    static ChiefRays of(L lens) {
        if constexpr (requires { lens.iris = {}; }) lens.iris = {};   // they need none
        ChiefRays rays;
        rays.straight_ = std::move(lens);
        return rays;
    }
    static ChiefRays of(const ExactLens& lens);

    /// Chief ray of a film point (mm, upright). Beyond what an exact lens draws the outermost ones
    /// are continued linearly in the film radius, for points that leave the frame. Where a
    /// projection has no direction it is 0.
    ChiefRay at(Vec2d film_mm) const;

    /// The film point (mm, upright) whose chief ray meets a point of the camera frame;
    /// nothing if it lies behind. Homogeneous: (p, 1) is a point in m, (d, 0) lies in
    /// direction d at infinity.
    std::optional<Vec2d> film_point(Vec3d p, double w = 1) const;

    /// Whether light comes to a film point: as far as the table tells.
    Lit lit(Vec2d film_mm) const;

    /// In the plane of the axis: the line n . x = offset with the normal n = (cos angle,
    /// sin angle) in (outward, z), followed along (sin angle, -cos angle) from `start` m
    /// past its foot point.
    struct Meridional {
        double angle = 0, offset = 0, start = 0;
    };

  private:
    friend class ChiefRaysOverTime;
    ChiefRays() = default;
    void tabulate(const ExactLens& lens);
    /// Chief rays of a moment between two keys: between them, if the lens changes evenly, else the nearer's.
    static ChiefRays between(const ChiefRays& a, const ChiefRays& b, double share);
    bool changes_evenly() const;
    Meridional at_radius(double mm) const;
    std::optional<double> solve(double outward, double z, double w) const;

    std::optional<LensKind> straight_;   // a kind that has film_point(); else it is an exact lens
    std::optional<ChiefGrid> grid_;      // of one that is not the same on all sides
    std::vector<Meridional> table_;      // of another, by film radius
    double step_mm_ = 0;
    bool ends_ = false;                  // the table, before the film does: beyond the image circle
};

/// Those of a camera whose lens changes while the shutter is open: of the lens that draws
/// at each time.
class ChiefRaysOverTime {
  public:
    explicit ChiefRaysOverTime(const Camera& camera);

    /// Calls use(chief rays) with those of `time`; a lens that stays as it is pays
    /// nothing.
    template <typename Use>
    decltype(auto) with_lens(float time, const Use& use) const {
        if (times_.empty()) return use(states_.front());
        const KeyPlace p = place_among(times_, time);
        const ChiefRays &a = states_[p.left], &b = states_[p.right];
        if (!a.changes_evenly()) return use(p.share < 0.5 ? a : b);   // as exact lenses draw
        return use(ChiefRays::between(a, b, p.share));
    }

  private:
    std::vector<float> times_;  // empty: one state
    std::vector<ChiefRays> states_;
};

}  // namespace dg
