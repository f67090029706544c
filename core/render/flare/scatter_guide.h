// scatter_guide.h -- importance sampling of light scattered inside the lens, learned once per picture by random walks:
// emitters and cells of the front. A defensive share of the paths chooses emitters by their illuminance at the lens, so
// that errors of the learned distribution cause noise and no bias.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "math/distribution.h"
#include "render/flare/flare_aim.h"

namespace dg {

class ScatterGuide {
  public:
    /// `scene` and `camera`: the same as in `aim`. Throws Error for a lens with an unknown barrel.
    ScatterGuide(std::shared_ptr<const FlareAim> aim, const Scene& scene, const Camera& camera,
                 const RenderSettings& settings);

    /// No light source, or no scattering part.
    bool empty() const { return sources_.empty(); }
    const FlareAim& aim() const { return *aim_; }

    /// Samples a path; empty if it carries no light.
    std::optional<FlareArrival> draw(float source, Vec2f front, const FlareAim::Random& u) const;

    /// A random walk for each wavelength, with common random numbers, so that they take similar paths.
    struct Landings {
        std::array<Reprojection, kWavelengths> at;
        std::array<float, kWavelengths> blur2_mm2;   // ScatteredLight::blur2
    };
    Landings trace(const FlareArrival& path, std::uint64_t seed) const;
    /// Scattered light of the whole frame as estimated by walks, exposure x mm2. 0: none found.
    double light() const { return light_; }

  private:
    struct State {
        ExactLens lens;
        ScatterLens parts;
    };
    /// Distribution of front points of a source: cells of FlareAim's square, mixed with a uniform share.
    struct Front {
        Distribution2D cells;
        double blind = 1;
        Vec2f sample(Vec2f u) const;
        double pdf(Vec2f at) const;   // per unit of the square
    };
    /// Result of a number of walks from a source.
    struct Found {
        double light = 0;
        int hits = 0;
        std::vector<double> squares;   // second moment of light, per cell
    };
    void learn(int threads);
    Found look(int source, int walks) const;
    static Front front_of(const Found& found);
    std::optional<double> light_of(const FlareArrival& path, float nm, std::uint64_t seed) const;

    const Scene& scene_;
    const Camera& camera_;
    std::shared_ptr<const FlareAim> aim_;
    std::vector<State> states_;
    DiscreteDistribution sources_;
    double light_ = 0;
    std::vector<Front> fronts_;   // per source
};

}  // namespace dg
