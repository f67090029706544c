// ghost_places.h -- cache of the front regions of a lens's ghosts, by the angle of the source from the axis. Entries
// are computed on demand, and are valid while lens and frame stay the same.
//
// Entries are at angles several degrees apart, for sources on one side at quantized distances. A picture interpolates
// between the two nearest angles, so it does not depend on whether entries were cached.
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
    /// Whether the lens can be cached: it is rotationally symmetric and does not change during the exposure.
    static bool can_keep(const Camera& camera);
    /// Azimuth of a source about the axis, rad; the front's square is rotated by it.
    static double turn_of(const Camera& camera, const MapSource& source);

    /// Sets lens and frame of the following pictures; returns whether they are unchanged.
    bool set_lens(const Camera& camera, const Sensor& sensor);
    /// All ghosts with two reflections for a source; empty entries for irrelevant ghosts.
    std::vector<std::optional<KnownGhost>> of(const FlareAim& aim, const MapSource& source, int threads);
    /// Number of exact rays traced by of() since set_lens().
    std::size_t rays() const { return rays_; }

  private:
    /// Lens, and quantized angle and nearness.
    using Key = std::tuple<std::string, int, int>;
    using Places = std::shared_ptr<const std::vector<std::shared_ptr<const GhostPlace>>>;   // per ghost; null: dim
    struct Angle {
        Places places;
        std::uint64_t used = 0;
    };
    Places at(const FlareAim& aim, int angle, int near, int threads);
    Places find(const FlareAim& aim, int angle, int near, int threads);

    std::string lens_;
    Sensor frame_;          // a square around the axis that contains the frame at any rotation
    double step_rad_ = 0;
    std::map<Key, Angle> angles_;   // includes previous lenses
    std::uint64_t uses_ = 0;
    std::size_t rays_ = 0;
};

}  // namespace dg
