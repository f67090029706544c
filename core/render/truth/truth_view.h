// truth_view.h -- the camera of a frame for ground truth: chief rays of film points at the times of their lines, and
// film points of world points.
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

    /// The chief ray of a film point, in the world; empty outside the lens's field.
    std::optional<Ray> ray(Vec2d px) const;

    /// Film position (px) of a world point (w = 1) or direction (w = 0) at `time`.
    std::optional<Vec2d> px_of(Vec3d point, double w, float time) const;
    /// Film position (px) at `time` of a hit, which follows its surface to that time.
    std::optional<Vec2d> px_of(const Seen& seen, float time) const;

    /// Film position (px) of a hit at the time of the line where it is imaged; `px` is the initial guess.
    std::optional<Vec2d> landing(const Seen& seen, Vec2d px) const {
        return landing_of([&](float time) { return px_of(seen, time); }, px);
    }
    /// Film position (px) of a moving point at the time of the line where it is imaged. px_at(time): its position.
    template <typename PxAt>
    std::optional<Vec2d> landing_of(const PxAt& px_at, Vec2d px) const {
        if (!settings_.shutter.rolls()) return px_at(time_at(px));
        for (int round = 0; round < kRounds; ++round) {  // converges if the point is slower than the lines
            const auto next = px_at(time_at(px));
            if (!next || length(*next - px) < kSettled) return next;
            px = *next;
        }
        return bisected(px_at);
    }

    /// Film shift at `time`, mm, in addition to the sensor's shift.
    Vec2d shift(float time) const;

    const Scene& scene() const { return scene_; }
    const Camera& camera() const { return camera_; }
    const RenderSettings& settings() const { return settings_; }

  private:
    static constexpr int kRounds = 16;  // fixed-point iterations for the line of a point
    static constexpr double kSettled = 1e-5;  // px

    /// Bisection, for a point that moves at least as fast as the lines. Times are clamped to the first and last line,
    /// so the point is imaged beyond them or crosses a line in between.
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
            if (further == (i == 1) && i < 2) return px;  // outside the frame
            (further ? low : high) = middle;
        }
        return px;
    }

    const Scene& scene_;
    const Camera& camera_;
    const RenderSettings& settings_;
    ChiefRaysOverTime chief_;
};

/// Center of pixel i of a region, px of the full frame.
inline Vec2d centre(const FilmLayout& region, std::size_t i) {
    return {region.offset_x + double(i % region.width) + 0.5,
            region.offset_y + double(i / region.width) + 0.5};
}

}  // namespace dg
