// flare_guide.h -- importance sampling of ghosts, learned once per picture: pairs of source and ghost, and points on
// the front of the lens.
//
// Few pairs send light to the frame, each through a small part of the front; both are learned from exact rays
// (flare_learn.h). A defensive share of the paths is drawn without this knowledge, so that errors of the learned
// distribution cause noise and no bias.
#pragma once
#include <memory>
#include <optional>

#include "render/flare/flare_aim.h"
#include "render/flare/flare_learn.h"
#include "render/flare/maps/flare_sheets.h"

namespace dg {

class FlareGuide {
  public:
    FlareGuide(std::shared_ptr<const FlareAim> aim, const RenderSettings& settings);

    /// No flare: no light source, or no reflecting surface.
    bool empty() const { return !has_paths() && sheets_.empty(); }
    /// Whether there are pairs without maps.
    bool has_paths() const { return !known_.pairs.empty(); }
    /// Share of all paths for pairs without maps: their share of the light with a lower bound; 0 if there are none.
    double paths_share() const;
    const FlareSheets& sheets() const { return sheets_; }
    const FlareAim& aim() const { return *aim_; }
    std::shared_ptr<const FlareAim> shared_aim() const { return aim_; }

    /// Random numbers of a path.
    struct Random {
        float pair, select, lambda;
        Vec2f front, point;
        Moment moment;
    };
    std::optional<FlareArrival> draw(const Random& u) const;

  private:
    std::shared_ptr<const FlareAim> aim_;
    FlareSheets sheets_;
    FlareKnowledge known_;
};

}  // namespace dg
