// flare_guide.h -- what ghosts are drawn by, found once for a picture: a pair of source and ghost, and a place on
// the front of the lens.
//
// Few pairs bring light to the frame, and each through a small part of the front; both are learned from exact
// rays (flare_learn.h). A share of the paths is drawn without that knowledge, so that what the rays missed costs
// noise and no bias.
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

    /// Nothing shines, or nothing reflects: there is no flare.
    bool empty() const { return !has_paths() && sheets_.empty(); }
    /// There is something that maps do not have.
    bool has_paths() const { return !known_.pairs.empty(); }
    /// Share of all paths that it gets: as its sources have of all light, and some more; 0: there is nothing.
    double paths_share() const;
    const FlareSheets& sheets() const { return sheets_; }
    const FlareAim& aim() const { return *aim_; }
    std::shared_ptr<const FlareAim> shared_aim() const { return aim_; }

    /// From random numbers by purpose; nothing if the path cannot bring light.
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
