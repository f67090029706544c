// scatter_guide.h -- which emitters bring light that the lens's own parts scatter onto the frame: found once for
// a picture, by walks. A share of the paths goes by what the emitters bring to the lens, whatever was found, so
// that what the walks missed costs noise and no bias.
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
    /// The aim's scene and camera. Error for a lens whose barrel is not known.
    ScatterGuide(std::shared_ptr<const FlareAim> aim, const Scene& scene, const Camera& camera,
                 const RenderSettings& settings);

    /// Nothing shines, or nothing scatters.
    bool empty() const { return sources_.empty(); }
    const FlareAim& aim() const { return *aim_; }

    /// From random numbers by purpose; nothing if the path cannot bring light.
    std::optional<FlareArrival> draw(float source, Vec2f front, const FlareAim::Random& u) const;

    /// One walk for each wavelength, all by the same numbers: they go about the same way.
    struct Landings {
        std::array<Reprojection, kWavelengths> at;
        std::array<float, kWavelengths> blur2_mm2;   // ScatteredLight::blur2
    };
    Landings trace(const FlareArrival& path, std::uint64_t seed) const;
    /// Scattered light of the whole frame as walks found it: exposure x mm2. 0: they found none.
    double light() const { return light_; }

  private:
    struct State {
        ExactLens lens;
        ScatterLens parts;
    };
    /// Where light of a source enters that comes to the frame: cells of FlareAim's square; a share of the paths
    /// goes to all of it evenly.
    struct Front {
        Distribution2D cells;
        double blind = 1;
        Vec2f sample(Vec2f u) const;
        double pdf(Vec2f at) const;   // per unit of the square
    };
    /// Results of some walks from a source to the frame.
    struct Found {
        double light = 0;
        int hits = 0;
        std::vector<double> squares;   // of light, by cell
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
    std::vector<Front> fronts_;   // by source
};

}  // namespace dg
