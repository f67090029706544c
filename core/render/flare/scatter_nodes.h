// scatter_nodes.h -- scattered light on nodes 2 to 32 px apart (maps/coarse_light.h): it is smooth, and one path in ten
// comes to the frame, so each of them shines on as many pixels as it may.
//
// The lobes of a path's scatters, and the front where it enters, spread light over the film
// (optics/stray/scatter_blur.h), by a shape that falls as a power of the distance from its middle, r^slope. A kernel
// whose variance is c times that of the blur, which grows as r^2, changes such a shape by the share c slope'^2 / 2
// (slope' = slope + 2) wherever the power holds: so much, and no more than the smooth light of the barrel allows at its
// edges, is the kernel of a path. In the narrow peak of a fine polish, or where
// parts of the lens have a sharp image on the film, it gets so small that a path keeps to its pixels (ray_on_film.h).
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "render/flare/maps/coarse_light.h"
#include "render/flare/scatter_guide.h"
#include "render/pass.h"

namespace dg {

class ScatterNodes {
  public:
    static constexpr int kFinest = 1, kLevels = CoarseLight::kMostLevel + 1;

    /// Whether a film and its filter allow nodes, and walks know how bright the light is.
    static bool serve(const Picture& picture, const ScatterGuide& guide);
    ScatterNodes(const Picture& picture, const ScatterGuide& guide);

    /// Light that is yet to be added, of one thread.
    using Work = std::array<std::vector<CoarseLight::Arrival>, kLevels>;
    /// Wavelengths of a path that go to nodes.
    struct Places {
        struct Place {
            int wavelength = 0, level = 0;
            Vec2f px{};
            float light = 0;   // for a radiance of 1 and paths of density 1
        };
        std::array<Place, kWavelengths> all;
        int count = 0;
    };
    /// Takes from the landings those that go to nodes: their etendue becomes 0. u in [0, 1) draws the level.
    Places take(ScatterGuide::Landings& landings, float time, float u) const;
    /// `sample`: where light that is no number counts as bad.
    void add(Work& work, const Places& places, const Wavelengths& wavelengths, Spectrum light, std::uint32_t sample) const;
    void flush(Work& work) const;
    /// All of it to the film.
    void finish(int threads) const;

  private:
    int level_of(float blur2_mm2, float u) const;
    bool reaches(Vec2f px, float reach) const;
    float exposed(Vec2f px, float time) const;

    Picture picture_;
    float px2_per_mm2_, exposure_;   // exposure_: of a pixel, for a response of 1 while the shutter is open
    float most_;                     // px2: variance of the widest kernel
    int values_;
    std::array<std::unique_ptr<CoarseLight>, kLevels> coarse_;   // by level, from kFinest on
};

}  // namespace dg
