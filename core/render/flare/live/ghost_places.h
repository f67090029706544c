// ghost_places.h -- where the ghosts of a lens come through its front, by the angle of the source from the axis: found
// when a source first stands near that angle, and kept while lens and frame stay the same.
//
// Places are known at angles some degrees apart, for sources on one side, at some distance; rays of a picture then start
// from what lies between the two next to it. So a picture is the same whether its places were kept or found for it.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "render/flare/flare_aim.h"
#include "render/flare/live/ghost_place.h"

namespace dg {

class GhostPlaces {
  public:
    /// Whether places of such a lens can be kept: it is the same all around, and does not change meanwhile.
    static bool can_keep(const Camera& camera);
    /// The angle about the axis at which a source stands: the square's sides turn with it.
    static double turn_of(const Camera& camera, const MapSource& source);

    /// Takes lens and frame of the pictures that follow; whether they are those of the call before.
    bool set_lens(const Camera& camera, const Sensor& sensor);
    /// All ghosts of two reflections, for a source before that lens: nothing of those that do not matter.
    std::vector<std::optional<KnownGhost>> of(const FlareAim& aim, const MapSource& source, int threads);
    /// Exact rays that of() has taken since set_lens().
    std::size_t rays() const { return rays_; }

  private:
    /// Angle and nearness in steps.
    using Key = std::tuple<std::string, int, int>;
    using Places = std::shared_ptr<const std::vector<std::shared_ptr<const GhostPlace>>>;   // of all ghosts; null: dim
    struct Angle {
        Places places;
        std::uint64_t used = 0;
    };
    Places at(const FlareAim& aim, int angle, int near, int threads);
    Places find(const FlareAim& aim, int angle, int near, int threads);

    std::string lens_;
    Sensor frame_;          // a square about the axis that holds the frame, however that is turned
    double step_rad_ = 0;
    std::map<Key, Angle> angles_;   // also of lenses before
    std::uint64_t uses_ = 0;
    std::size_t rays_ = 0;
};

}  // namespace dg
