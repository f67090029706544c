// scatter_lens.h -- a lens as a closed box of scattering parts: polished surfaces, barrel walls
// between their rims, and iris blades. Random walks trace light through it.
//
// Gap i is the space in front of surface i. Its wall is the cone between the rims of the clear
// apertures on both sides: mounts hold the glass there, and the edges of the glass are painted like
// them. At the iris, the wall is as wide as the open stop, or as the straight line between its
// neighbours. There are no walls in front of the first surface or between the last surface and the
// film.
//
// Only scattered light is recorded: light without an event at a wall, a blade or a rough surface
// belongs to the image and its ghosts.
// ghosts' own.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "optics/stray/finish.h"
#include "optics/stray/ghost_lens.h"

namespace dg {

/// Scattering properties of the parts of a lens.
struct LensScatter {
    Finish barrel{}, blades{};
    double surface_rms_nm = 1;   // RMS roughness of all polished surfaces; 0: perfectly smooth
    HarveyShack surface_lobe{};

    /// Whether any part scatters.
    bool scatters() const {
        const auto shines = [](const Finish& f) { return f.diffuse > 0 || f.gloss > 0; };
        return shines(barrel) || shines(blades) || surface_rms_nm > 0;
    }
};

/// Throws an Error with the name of the faulty value.
void check_scatter(const LensScatter& scatter);

/// Result of a walk that reached the film.
struct ScatteredLight {
    Vec2d film{};        // mm, in coordinates of the film plane
    Vec2d iris{};        // mm, last crossing of the stop
    double weight = 0;   // relative to the light that entered
    int events = 0;      // number of scattering events; 0: image or ghost (ScatterDraw::all)
    double blur2 = 0;    // mm2, squared radius of the footprint on the film (scatter_blur.h)
};

/// Final states of the light. `lost`: between overlapping surfaces of a prescription. `chance`:
/// weight gained or lost by random sampling; 0 in expectation.
enum class LightEnd { film, front, metal, glass, rear, truncated, lost, chance };
inline constexpr int kLightEnds = 8;
using LightEnds = std::array<double, kLightEnds>;

/// Sampling strategies of walks; all are unbiased.
struct ScatterDraw {
    bool toward_film = true;   // false: the adjoint walk, from the film to the front
    bool aimed = true;         // part of the scattering off metal is aimed at the film
    bool forced = true;        // half of the walks are forced to scatter at a polished surface
    bool roulette = true;          // Russian roulette for walks of low weight
    bool all = false;          // also returns walks without scattering
};

class ScatterLens {
  public:
    /// Arguments as in GhostLens. Throws Error for a lens without axial symmetry or with unknown
    /// clear diameters, and for an invalid finish.
    ScatterLens(const Prescription& lens, const FilmPlane& film, const Iris& iris, double iris_radius,
                const SensorStack& stack, double half_diagonal, const LensScatter& scatter);

    const GhostLens& ghosts() const { return ghosts_; }
    const LensScatter& scatter() const { return scatter_; }
    LensIndices at(double wavelength_nm) const { return ghosts_.tracer().at(wavelength_nm); }

    /// Traces one walk from the ray, which must start before the first surface (adjoint: the last).
    /// Returns the light that reaches the film (adjoint: the light that leaves the front, with its
    /// ray in `left`) after at least one scattering event. A seed gives the same walk at all
    /// wavelengths, up to dispersion. iris_opening: fraction of the iris radius. `ends` receives
    /// the walk's light by final state, 1 in total.
    std::optional<ScatteredLight> walk(const LensRay& ray, const LensIndices& n, double iris_opening,
                                       std::uint64_t seed, const ScatterDraw& draw, LightEnds* ends = nullptr,
                                       LensRay* left = nullptr) const;

    /// End of a wall, for drawings and tests: radius and z, mm.
    struct Rim {
        double radius, z;
    };
    const std::vector<Rim>& rims() const { return rims_; }   // of the surfaces of the lens

  private:
    class Walk;
    /// Cone between the rims of surfaces gap - 1 and gap.
    struct Wall {
        double radius = 0, z = 0, length = 0, slope = 0;   // at the front end; slope: radius per length
        double end_radius = 0;
        bool none = false;
    };
    /// Disc perpendicular to the axis. Light is aimed toward it, or away from a virtual image
    /// behind.
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
    std::vector<double> clear_;      // mm, by surface; at the stop: radius of the wall
    std::vector<Rim> rims_;
    std::vector<Wall> walls_;        // by gap
    std::vector<std::vector<Target>> targets_;   // by gap
    double forced_ = 0;              // probability of a forced scatter at a polished surface, for unscattered walks
};

}  // namespace dg
