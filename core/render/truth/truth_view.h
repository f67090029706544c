// truth_view.h -- one frame's camera as ground truth asks it: rays of film points at their own
// moments, and where points of the world lie on the film.
#pragma once
#include <optional>

#include "camera/inverse/chief.h"
#include "render/truth/truth.h"

namespace dg {

class TruthView {
  public:
    TruthView(const TruthFrame& frame, const RenderSettings& settings);

    float time_at(Vec2d px) const { return float(settings_.shutter.opens_at(px)); }
    Affine3d pose(float time) const { return camera_.world_from_camera.at(time); }

    /// The chief ray of a film point, in the world; nothing where the camera sees nothing.
    std::optional<Ray> ray(Vec2d px) const;

    /// Where a point of the world (w = 1) or a direction (w = 0) lies on the film at `time`.
    std::optional<Vec2d> px_of(Vec3d point, double w, float time) const;
    /// The same of something that was seen, as it has moved until then.
    std::optional<Vec2d> px_of(const Seen& seen, float time) const;

    /// Where it lands at the moment of the line on which it lands; `px` is a first guess.
    std::optional<Vec2d> landing(const Seen& seen, Vec2d px) const {
        return landing_of([&](float time) { return px_of(seen, time); }, px);
    }
    /// The same of anything that has a place on the film at a time: px_at(time).
    template <typename PxAt>
    std::optional<Vec2d> landing_of(const PxAt& px_at, Vec2d px) const {
        if (!settings_.shutter.rolls()) return px_at(time_at(px));
        for (int round = 0; round < kRounds; ++round) {  // settles if slower than the lines
            const auto next = px_at(time_at(px));
            if (!next || length(*next - px) < kSettled) return next;
            px = *next;
        }
        return bisected(px_at);
    }

    /// Shift of the film, mm, beside what the sensor has anyway.
    Vec2d shift(float time) const;

    const Scene& scene() const { return scene_; }
    const Camera& camera() const { return camera_; }
    const RenderSettings& settings() const { return settings_; }

  private:
    static constexpr int kRounds = 16;  // of the plain search for the line of a point
    static constexpr double kSettled = 1e-5;  // px

    /// Bisects for a point that moves as fast as the lines, or faster. Before the first line and past the last one time
    /// is held, so it lands there or crosses some line in between.
    template <typename PxAt>
    std::optional<Vec2d> bisected(const PxAt& px_at) const {
        const bool columns = settings_.shutter.scans_columns();
        double low = 0, high = columns ? settings_.sensor.width : settings_.sensor.height;
        std::optional<Vec2d> px;
        for (int i = 0; i < 50; ++i) {
            const double middle = i == 0 ? low : i == 1 ? high : 0.5 * (low + high);
            px = px_at(time_at({middle, middle}));
            if (!px) return px;
            const bool further = (columns ? px->x : px->y) > middle;
            if (further == (i == 1) && i < 2) return px;  // outside of the frame
            (further ? low : high) = middle;
        }
        return px;
    }

    const Scene& scene_;
    const Camera& camera_;
    const RenderSettings& settings_;
    ChiefRaysOverTime chief_;
};

/// The middle of pixel i of a region, px of the full frame.
inline Vec2d centre(const FilmLayout& region, std::size_t i) {
    return {region.offset_x + double(i % region.width) + 0.5,
            region.offset_y + double(i / region.width) + 0.5};
}

}  // namespace dg
