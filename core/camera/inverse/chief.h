// chief.h -- chief rays of a camera and their inverse: the film point that sees a scene point.
//
// The chief ray of a film point is the mean of its passing rays: it intersects any plane across it
// at the centroid of the film point's footprint on that plane. So it passes exactly through the
// point in focus, and through the centroid of the blur elsewhere; vignetting by the mounts shifts
// it. Ideal lenses: the ray through the centre of the lens, or through the pupils of a thick lens.
// Exact lenses: the mean at the design wavelength, averaged over rotations of the iris so that it
// depends only on the distance from the axis; for tilted, decentred and anamorphic lenses, a table
// over the film with the iris as it is.
// of tilted, decentred and anamorphic ones it is tabulated over the film, iris as it is.
#pragma once
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "camera/inverse/chief_grid.h"

namespace dg {

struct ChiefRay {
    Vec3d origin,
        direction;  // camera frame, m; unit; from the origin of the lens's rays
};

class ChiefRays {
  public:
    using Lit = ChiefGrid::Lit;

    /// Throws Error if no light passes an exact lens on its axis.
    explicit ChiefRays(const LensKind& lens);
    template <HasFilmPoint L>
    static ChiefRays of(L lens) {
        if constexpr (requires { lens.iris = {}; }) lens.iris = {};   // chief rays need no iris
        ChiefRays rays;
        rays.straight_ = std::move(lens);
        return rays;
    }
    static ChiefRays of(const ExactLens& lens);

    /// Chief ray of a film point (mm, upright). Beyond the image circle of an exact lens, it is
    /// extrapolated linearly in the film radius, for points that leave the frame. The direction is
    /// 0 outside a projection's field of view.
    ChiefRay at(Vec2d film_mm) const;

    /// Film point (mm, upright) with a chief ray through a point of the camera frame; empty if the
    /// point is behind the camera. Homogeneous: (p, 1) is a point in m, (d, 0) a direction at
    /// infinity.
    std::optional<Vec2d> film_point(Vec3d p, double w = 1) const;

    /// Whether light reaches a film point, as far as the table shows.
    Lit lit(Vec2d film_mm) const;

    /// Ray in the meridional plane: the line n . x = offset with normal n = (cos angle, sin angle)
    /// in coordinates (outward, z), directed along (sin angle, -cos angle); its origin is `start` m
    /// past the foot point.
    struct Meridional {
        double angle = 0, offset = 0, start = 0;
    };

  private:
    friend class ChiefRaysOverTime;
    ChiefRays() = default;
    void tabulate(const ExactLens& lens);
    /// Interpolates chief rays between two keys if the lens interpolates numbers; otherwise returns
    /// the nearer key.
    static ChiefRays between(const ChiefRays& a, const ChiefRays& b, double share);
    bool changes_evenly() const;
    Meridional at_radius(double mm) const;
    std::optional<double> solve(double outward, double z, double w) const;

    std::optional<LensKind> straight_;   // kind with film_point(); empty for exact lenses
    std::optional<ChiefGrid> grid_;      // exact lens without axial symmetry
    std::vector<Meridional> table_;      // exact lens with axial symmetry, by film radius
    double step_mm_ = 0;
    bool ends_ = false;                  // whether the table ends inside the film, at the image circle
};

/// Chief rays of a camera with a lens that changes over time: at each time, the chief rays of the
/// lens then in use.
class ChiefRaysOverTime {
  public:
    explicit ChiefRaysOverTime(const Camera& camera);

    /// Calls use(chief rays) for the lens at `time`; a constant lens has no overhead.
    template <typename Use>
    decltype(auto) with_lens(float time, const Use& use) const {
        if (times_.empty()) return use(states_.front());
        const KeyPlace p = place_among(times_, time);
        const ChiefRays &a = states_[p.left], &b = states_[p.right];
        if (!a.changes_evenly()) return use(p.share < 0.5 ? a : b);   // like generate_rays for exact lenses
        return use(ChiefRays::between(a, b, p.share));
    }

  private:
    std::vector<float> times_;  // empty: constant
    std::vector<ChiefRays> states_;
};

}  // namespace dg
