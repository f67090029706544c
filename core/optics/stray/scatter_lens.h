// scatter_lens.h -- a lens as a closed box: its surfaces, and between their rims the walls of the barrel; where
// the iris stands, its blades. Light is followed through it by chance, whatever it meets.
//
// A gap is the space before a surface (gap i lies before surface i). Its wall is the cone that joins the rims of
// the clear apertures on both sides of it: mounts hold the glass there, and the edge of a lens is as black as
// they are. At the iris the wall is as wide as the stop when it is open, or as the straight line between its
// neighbours. Nothing stands before the first surface, and nothing between the last one and the film.
//
// What scatters is counted once: light that no wall, blade or roughness has turned is the picture's and its
// ghosts' own.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "optics/stray/finish.h"
#include "optics/stray/ghost_lens.h"

namespace dg {

/// Scatter of the parts of a lens, which send light to where they should not.
struct LensScatter {
    Finish barrel{}, blades{};
    double surface_rms_nm = 1;   // roughness of every polished surface; 0: none
    HarveyShack surface_lobe{};

    /// Anything at all.
    bool scatters() const {
        const auto shines = [](const Finish& f) { return f.diffuse > 0 || f.gloss > 0; };
        return shines(barrel) || shines(blades) || surface_rms_nm > 0;
    }
};

/// Throws Error that names the value.
void check_scatter(const LensScatter& scatter);

/// Light that came to the film.
struct ScatteredLight {
    Vec2d film{};        // mm, in the film plane's coordinates
    Vec2d iris{};        // mm, where it last crossed the stop
    double weight = 0;   // of it, of the light that entered
    int events = 0;      // how often it was scattered; 0: the picture's or a ghost's (ScatterDraw::all)
    double blur2 = 0;    // mm2: how far around there such light is spread evenly, squared (scatter_blur.h)
};

/// Where light ends. `lost`: between surfaces of a prescription that run into each other. `chance`: what a walk
/// gained or lost by the way in which it was drawn; 0 in the mean.
enum class LightEnd { film, front, metal, glass, rear, truncated, lost, chance };
inline constexpr int kLightEnds = 8;
using LightEnds = std::array<double, kLightEnds>;

/// How walks are drawn; the mean does not depend on it.
struct ScatterDraw {
    bool toward_film = true;   // else from the film to the front: the same light, gone backward
    bool aimed = true;         // some of what metal scatters goes where the film is
    bool forced = true;        // half of the walks are made to scatter at some polished surface
    bool dice = true;          // dim walks are ended by chance
    bool all = false;          // what nothing scattered counts, too
};

class ScatterLens {
  public:
    /// Sets up like GhostLens. Error for a lens that is not the same all around its axis, or whose clear diameters
    /// are not known, and for a finish that cannot be.
    ScatterLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
                const SensorStack& stack, double half_diagonal, const LensScatter& scatter);

    const GhostLens& ghosts() const { return ghosts_; }
    const LensScatter& scatter() const { return scatter_; }
    LensIndices at(double wavelength_nm) const { return ghosts_.tracer().at(wavelength_nm); }

    /// One walk of light that enters at the ray, which has yet to meet the first surface (drawn backward: the
    /// last). What came to the film (backward: what left the front, see `left`) after something scattered it.
    /// The same `seed` draws the same walk, but for what another wavelength changes. iris_opening: of its
    /// radius. `ends` gains the walk's light, 1 in all.
    std::optional<ScatteredLight> walk(const LensRay& ray, const LensIndices& n, double iris_opening,
                                       std::uint64_t seed, const ScatterDraw& draw, LightEnds* ends = nullptr,
                                       LensRay* left = nullptr) const;

    /// A rim or a wall, for drawings and tests: radius and z, mm.
    struct Rim {
        double radius, z;
    };
    const std::vector<Rim>& rims() const { return rims_; }   // of the lens's own surfaces

  private:
    class Walk;
    /// Between the rims of surfaces gap - 1 and gap.
    struct Wall {
        double radius = 0, z = 0, length = 0, slope = 0;   // at its front end; radius per length
        double end_radius = 0;
        bool none = false;
    };
    /// A disc across the axis. Light is aimed at it, or away from it where it is an image that lies behind.
    struct Target {
        double z, radius, share;
    };
    void set_rims(const Prescription& lens);
    void set_walls();
    void set_targets(double half_diagonal);
    std::optional<Target> image_in(int gap, int from_gap, double z, double radius) const;

    GhostLens ghosts_;
    LensScatter scatter_;
    FinishScatter barrel_, blades_;
    std::vector<SurfaceCoating> coatings_;
    std::vector<double> clear_;      // mm, by surface; of the stop the wall's radius there
    std::vector<Rim> rims_;
    std::vector<Wall> walls_;        // by gap
    std::vector<std::vector<Target>> targets_;   // by gap
    double forced_ = 0;              // chance of a polished surface to scatter a walk that nothing has yet
};

}  // namespace dg
