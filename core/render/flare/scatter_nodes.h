// scatter_nodes.h -- scattered light on nodes 2 to 32 px apart (maps/coarse_light.h). Scattered light is smooth and
// only one path in ten reaches the frame, so each path is spread over as many pixels as its smoothness allows.
//
// The scattering lobes of a path, and the front where it enters, blur light on the film (optics/stray/scatter_blur.h)
// with a profile that falls as a power r^slope of the distance from its center. A kernel with a variance of c times the
// variance of the blur, which grows as r^2, changes such a profile by the fraction c slope'^2 / 2, with slope' =
// slope + 2, wherever the power law holds. The kernel of a path has this variance for a small c, limited to the width
// that the edges of the barrel's smooth light allow. For the narrow peak of a fine polish, or where lens parts have a
// sharp image on the film, the kernel is below the node spacing, and the path is splatted to pixels (ray_on_film.h).
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

    /// Whether film and filter allow nodes, and the guide's walks have found light.
    static bool serve(const Picture& picture, const ScatterGuide& guide);
    ScatterNodes(const Picture& picture, const ScatterGuide& guide);

    /// Light of a thread that is not added yet.
    using Work = std::array<std::vector<CoarseLight::Arrival>, kLevels>;
    /// Wavelengths of a path that are splatted to nodes.
    struct Places {
        struct Place {
            int wavelength = 0, level = 0;
            Vec2f px{};
            float light = 0;   // for a radiance of 1 and a path density of 1
        };
        std::array<Place, kWavelengths> all;
        int count = 0;
    };
    /// Removes the landings for nodes by setting their etendue to 0. u in [0, 1) chooses the level.
    Places take(ScatterGuide::Landings& landings, float time, float u) const;
    /// `sample`: sample index under which non-finite light counts as bad.
    void add(Work& work, const Places& places, const Wavelengths& wavelengths, Spectrum light, std::uint32_t sample) const;
    void flush(Work& work) const;
    /// Adds all nodes to the film.
    void finish(int threads) const;

  private:
    int level_of(float blur2_mm2, float u) const;
    bool reaches(Vec2f px, float reach) const;
    float exposed(Vec2f px, float time) const;

    Picture picture_;
    float px2_per_mm2_, exposure_;   // exposure_: of a pixel at a response of 1 while the shutter is open
    float most_;                     // px2: variance of the widest kernel
    int values_;
    std::array<std::unique_ptr<CoarseLight>, kLevels> coarse_;   // per level, from kFinest on
};

}  // namespace dg
