// exact.h -- exact lens: rays are traced through every surface of a prescription. Converts from mm
// (optics) to metres (camera).
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "camera/axial.h"
#include "camera/camera_sample.h"
#include "camera/lens_mask.h"
#include "math/made_once.h"
#include "optics/aim/pupil.h"
#include "optics/expansion/lens_fit.h"
#include "optics/first_order/paraxial.h"
#include "optics/stray/open_ghost.h"
#include "optics/stray/scatter_lens.h"

namespace dg {

class ChiefRays;

/// Traces a polynomial fit of the lens (optics/expansion/lens_fit.h) instead of its surfaces.
struct FittedGlass {
    int degree = 7;
};

struct ExactLensSettings {
    double f_stop = 0;  // 0: wide open
    Iris iris{};
    double focus_distance_m = std::numeric_limits<double>::infinity();
    FocusFrom focus_from = FocusFrom::pupil;
    double half_diagonal_mm = 21.64;  // radius of the film to cover, including shift
    PupilDraw draw = PupilDraw::aimed;
    /// z of the film in the lens frame, mm, if focus is already solved; replaces focus_distance_m.
    std::optional<double> film_z{};
    /// Rotation of the lens about the centre of its entrance pupil, see tilt.h. The lens's axis
    /// meets the film at film_z; (0, 0) on the film is the landing point of the chief ray along the
    /// camera's -z axis.
    Vec2d tilt_deg{};
    /// Used part of the film, mm, upright; half 0: all within half_diagonal_mm.
    Vec2d film_center_mm{}, film_half_mm{};
    std::optional<FittedGlass> fitted{};
};

/// A prescription at a focus distance and f-stop, prepared to generate rays. Cheap to copy.
class ExactLens {
  public:
    /// Throws Error if the lens cannot open or focus as requested (see paraxial.h).
    ExactLens(const Prescription& lens, const ExactLensSettings& settings);

    /// This lens at another time of the exposure. `middle` is the lens at mid-exposure: both share
    /// a camera body with a fixed film, so focusing moves the glass. Weights are exposures divided
    /// by the H0 of `middle`.
    ExactLens in_the_body_of(const ExactLens& middle) const;

    /// Copy of this lens with dirt masks, which attenuate rays. H0 stays the H0 of the clean lens.
    /// Throws Error for mask values outside [0, 1].
    ExactLens with_dirt(LensDirt dirt) const;

    bool is_dirty() const { return dirt_ != nullptr; }

    /// Copy of this lens that draws from this fit.
    ExactLens with_fit(LensFit fit) const;
    /// Copy of this lens that traces surfaces instead of the fit.
    ExactLens without_fit() const;
    /// Polynomial fit with its errors; null if the lens traces surfaces.
    const LensFit* fit() const;

    /// Generates rays that start on the first surface. Film points beyond half_diagonal_mm get
    /// weight 0.
    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    /// Traces scene rays (camera frame, from the first surface) to the film, each at its wavelength
    /// in nm.
    void reproject(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                   std::span<Reprojection> out) const;

    /// Ghosts of the lens with the given sensor stack. Throws Error for an invalid stack.
    GhostLens ghosts(const SensorStack& stack) const;
    /// Traces scene rays along a ghost path of ghosts() to the film. Leaf shutters apply at every
    /// crossing of the iris, dust on the iris at the last. Aim weight and etendue are 0, since
    /// camera rays do not sample ghosts.
    void reproject(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                   const GhostLens& ghosts, const std::vector<GhostStep>& steps,
                   std::span<Reprojection> out) const;

    /// Traces up to kLensBatch unclipped scene rays, with any origin in front of the lens, along a
    /// ghost path. Returns the offset from which film coordinates are subtracted to give upright
    /// image points, mm.
    Vec2f trace_open(std::span<const CameraRay> rays, std::span<const float> wavelength_nm, const GhostLens& ghosts,
                     const std::vector<GhostStep>& steps, OpenLandings& out) const;

    /// The lens with barrel walls and blades. Throws Error if their dimensions are unknown or a
    /// finish is invalid (scatter_lens.h).
    ScatterLens scatter(const SensorStack& stack, const LensScatter& parts) const;
    /// Landing point and light of a random walk. Aim weight and etendue are 0, since camera rays do
    /// not sample scatter.
    struct Scattered {
        Reprojection landing{};
        float blur2_mm2 = 0;   // mm2, squared radius of the footprint on the film
    };
    /// Random walk of a scene ray through the scattering lens, seeded by `seed`.
    Scattered reproject(const CameraRay& ray, const LensIndices& n, const ScatterLens& lens,
                        std::uint64_t seed) const;

    /// Bounding ball (camera frame, m) of the clear front of the first surface.
    struct Ball {
        Vec3d center;
        double radius;
    };
    Ball front_ball() const;

    /// Origin of a scene ray on the first surface (camera frame, m); the ray is a line in both
    /// directions.
    std::optional<Vec3d> start(Vec3d point, Vec3d direction) const;
    /// z of the centre of the entrance pupil, m: nonzero only for lenses of in_the_body_of().
    double pupil_offset_m() const { return 1e-3 * advance_; }

    /// View direction (unit, camera frame) of a film point in mm, upright: mean direction of the
    /// passing rays at the design wavelength. (0, 0, -1) if no ray passes.
    Vec3d chief_direction(Vec2d film_mm) const;

    /// Luminance exposure on the axis per scene luminance, the normalization of weights.
    double h0() const;
    /// Transmittance along the axis, luminance-weighted over a D65 spectrum.
    double transmittance() const;
    double f_stop() const;
    double iris_radius_mm() const;
    double film_z_mm() const;         // in the lens frame
    FilmPlane film_plane() const;     // in the lens frame; image coordinates are inverted
    double film_distance_mm() const;  // from the rear principal point
    double half_diagonal_mm() const;
    const ExactLensSettings& settings() const;
    /// Whether the lens is rotationally symmetric about the camera's axis.
    bool is_axial() const;
    const FirstOrder& first_order() const;  // design wavelength
    const Aim& aim() const;
    const Tracer& tracer() const;
    const LensTables& tables() const;
    /// Chief rays (camera/inverse/chief.h), shared by all copies of the lens.
    const MadeOnce<ChiefRays>& chief_rays() const { return chief_; }

  private:
    struct State;
    /// Transmittance of a leaf shutter, open to a fraction of the iris radius, at an iris
    /// point; excludes the iris.
    float leaf_transmission(float opening, float x_mm, float y_mm) const;
    /// Product of both dirt masks for a ray's front point and iris point (lens frame, mm).
    float dirt_transmission(Vec2f front_mm, Vec2f iris_mm) const;
    struct Buffers;
    /// Loads rays [begin, begin + count) of the camera frame into a batch, padded to a multiple of
    /// the lane count; returns the padded count.
    int fill(Buffers& b, std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
             std::size_t begin, int count) const;
    std::shared_ptr<const State> state_;
    std::shared_ptr<const LensDirt> dirt_;   // null: clean
    MadeOnce<ChiefRays> chief_;
    bool fitted_;
    double unit_;            // exposure of weight 1
    double advance_ = 0;     // camera frame, mm: z of the centre of the entrance pupil
    Vec2f film_shift_{0, 0};   // mm: film of the body relative to this lens's film
};

}  // namespace dg
