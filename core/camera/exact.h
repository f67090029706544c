// exact.h -- the exact lens: every surface of a prescription is traced. Here mm become
// metres.
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

/// The glass as polynomials (optics/expansion/lens_fit.h) instead of surface by surface.
struct FittedGlass {
    int degree = 7;
};

struct ExactLensSettings {
    double f_stop = 0;  // 0: as wide as the lens opens
    Iris iris{};
    double focus_distance_m = std::numeric_limits<double>::infinity();
    FocusFrom focus_from = FocusFrom::pupil;
    double half_diagonal_mm = 21.64;  // of the film that must be covered, shift included
    PupilDraw draw = PupilDraw::aimed;
    /// z of the film in the lens frame, mm, if focus was solved elsewhere; focus_distance_m is not used then.
    std::optional<double> film_z{};
    /// The lens is turned about the centre of its entrance pupil, see tilt.h. Its axis meets the film at
    /// film_z, and (0, 0) on the film is where the chief ray from straight ahead lands.
    Vec2d tilt_deg{};
    /// The part of the film that will be asked for, mm, upright; half 0: all within half_diagonal_mm.
    Vec2d film_center_mm{}, film_half_mm{};
    std::optional<FittedGlass> fitted{};
    /// aim_state() of an earlier lens; not used unless it was made for the same lens and settings.
    std::string cache{};
};

/// A prescription at one focus and f-stop, ready to draw rays. Cheap to copy.
class ExactLens {
  public:
    /// Error if the lens cannot open or focus like that (see paraxial.h).
    ExactLens(const Prescription& lens, const ExactLensSettings& settings);

    /// The same lens as a state of a body that is `middle` at mid-exposure: the film stays where it is in
    /// the body, so that focusing moves the glass; weights are exposures divided by the H0 of `middle`.
    ExactLens in_the_body_of(const ExactLens& middle) const;

    /// The same lens, dirty: rays lose what the pictures stop. H0 stays that of the clean one. Error if a
    /// value is not in [0, 1].
    ExactLens with_dirt(LensDirt dirt) const;

    bool is_dirty() const { return dirt_ != nullptr; }

    /// The same lens, traced surface by surface. Not fitted: itself.
    ExactLens without_fit() const;
    /// The fit that rays are drawn from instead of surfaces, if any; with its errors.
    const LensFit* fit() const;

    /// Rays start on the first surface. Film points beyond half_diagonal_mm get weight 0.
    void generate(std::span<const CameraSample> samples, std::span<CameraRay> rays) const;

    /// Follows scene rays (camera frame, from the first surface) back to the film, each at its wavelength
    /// in nm.
    void reproject(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                   std::span<Reprojection> out) const;

    /// The lens with its ghosts, before such a sensor. Error for a stack that cannot be.
    GhostLens ghosts(const SensorStack& stack) const;
    /// Follows scene rays by way of a ghost of ghosts(): what comes to the film, and where. Leaf shutters
    /// stand at every crossing of the iris, dust on the iris at the last. No camera ray is drawn like that:
    /// aim weight and etendue are 0.
    void reproject(std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
                   const GhostLens& ghosts, const std::vector<GhostStep>& steps,
                   std::span<Reprojection> out) const;

    /// Follows up to kLensBatch scene rays, which may start anywhere before the lens, by a ghost that nothing stops.
    /// Returns what the film's coordinates are taken off from, mm: the picture is upright.
    Vec2f trace_open(std::span<const CameraRay> rays, std::span<const float> wavelength_nm, const GhostLens& ghosts,
                     const std::vector<GhostStep>& steps, OpenLandings& out) const;

    /// The lens with barrel and blades. Error if those are not known or cannot be (scatter_lens.h).
    ScatterLens scatter(const SensorStack& stack, const LensScatter& parts) const;
    /// One walk of a scene ray through them, drawn by `seed`: where it comes to the film, and with how much
    /// light. No camera ray is drawn like that: aim weight and etendue are 0.
    struct Scattered {
        Reprojection landing{};
        float blur2_mm2 = 0;   // ScatteredLight::blur2
    };
    Scattered reproject(const CameraRay& ray, const LensIndices& n, const ScatterLens& lens,
                        std::uint64_t seed) const;

    /// A ball (camera frame, m) that holds the clear front of the first surface.
    struct Ball {
        Vec3d center;
        double radius;
    };
    Ball front_ball() const;

    /// Where a scene ray (camera frame, m; the line in both directions) starts: on the first surface.
    std::optional<Vec3d> start(Vec3d point, Vec3d direction) const;
    /// z of the middle of the entrance pupil, m: 0 but for states of a body.
    double pupil_offset_m() const { return 1e-3 * advance_; }

    /// Unit view direction (camera frame) of a film point, mm upright: through the middle
    /// of what the iris and the mounts let pass there at the design wavelength. Straight
    /// ahead if nothing passes.
    Vec3d chief_direction(Vec2d film_mm) const;

    /// Luminance exposure on the axis per scene luminance: what weights are divided by.
    double h0() const;
    /// Transmittance along the axis, luminance-weighted over a D65 spectrum.
    double transmittance() const;
    double f_stop() const;
    double iris_radius_mm() const;
    double film_z_mm() const;         // in the lens frame
    FilmPlane film_plane() const;     // in the lens frame; coordinates upside down
    double film_distance_mm() const;  // from the rear principal point
    double half_diagonal_mm() const;
    /// Results of the set-up, as bytes: with them the same lens is ready at once, with the same bits.
    std::string aim_state() const;
    const ExactLensSettings& settings() const;
    /// The same on all sides of the camera's axis.
    bool is_axial() const;
    const FirstOrder& first_order() const;  // design wavelength
    const Aim& aim() const;
    const Tracer& tracer() const;
    const LensTables& tables() const;
    /// Chief rays (camera/inverse/chief.h) that all copies of the lens share.
    const MadeOnce<ChiefRays>& chief_rays() const { return chief_; }

  private:
    struct State;
    /// Transmission there of an iris that is open to a fraction of its radius, in addition to the
    /// whole one: a leaf shutter on its way.
    float leaf_transmission(float opening, float x_mm, float y_mm) const;
    /// Transmission of both masks, for a ray of the front point and iris point (lens frame, mm).
    float dirt_transmission(Vec2f front_mm, Vec2f iris_mm) const;
    struct Buffers;
    /// Rays [begin, begin + count) of the camera's frame into lanes, of which some more than count are filled;
    /// how many.
    int fill(Buffers& b, std::span<const CameraRay> rays, std::span<const float> wavelength_nm,
             std::size_t begin, int count) const;
    std::shared_ptr<const State> state_;
    std::shared_ptr<const LensDirt> dirt_;   // null: clean
    MadeOnce<ChiefRays> chief_;
    bool fitted_;
    double unit_;            // the exposure of weight 1
    double advance_ = 0;     // camera frame, mm: z of the middle of the entrance pupil
    Vec2f film_shift_{0, 0};   // mm: of the body's film against this lens's own
};

}  // namespace dg
