// shutter.h -- exposure window and opening of the shutter for each part of the film.
//
// A point of the film is exposed for `exposure_s`; u in [0,1] is the relative time in that window,
// and the opening s(u) in 0..1 is the transmitted fraction of the light. Frames are H/H0 with H0
// for a fully open shutter: opening and closing darken the image by mean(s), the efficiency. A
// scanning shutter exposes lines of pixels line_time_s apart. Inside the renderer, time is the
// fraction of the scene's interval [0, duration_s].
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Opening s(u), piecewise linear; two points with equal u make a step.
class OpeningCurve {
  public:
    /// Box: open from 0 to 1.
    OpeningCurve();
    /// Linear opening and closing, with mean 1/2 (triangle) to 1 (box).
    static OpeningCurve trapezoid(double efficiency);
    /// 2 to 4096 points (u, s) with u non-decreasing within [0,1] and s >= 0; scaled to a maximum
    /// of 1; closed before the first point and after the last. Throws Error.
    static OpeningCurve points(std::span<const double> u, std::span<const double> s);

    double at(double u) const;
    double mean() const { return area_.back(); }
    /// Samples u with density s(u) / mean, from r in [0,1).
    double sample(double r) const { return box_ ? r : draw(r); }
    std::span<const double> places() const { return u_; }
    std::span<const double> values() const { return s_; }

  private:
    OpeningCurve(std::vector<double> u, std::vector<double> s);
    double draw(double r) const;
    std::vector<double> u_, s_, area_;   // area_[i]: integral of s up to u_[i]
    bool box_;                           // the usual case: no inversion needed
};

/// Side of the upright image that is exposed first; none: global shutter.
enum class ScanOrder { none, top, bottom, left, right };

struct ShutterSettings {
    double exposure_s = 0;       // of a point of the film, from first to last light
    OpeningCurve curve;
    ScanOrder scan = ScanOrder::none;
    double line_time_s = 0;      // between neighbouring lines of pixels
    bool leaf = false;           // the iris itself opens: `curve` is its radius relative to the f-stop's
};

/// Sample time, and iris radius at that time as a fraction.
struct Moment {
    float time = 0;
    float iris_opening = 1;
};

class Shutter {
  public:
    /// A single instant.
    Shutter() = default;
    /// Shutter for a frame of width x height pixels. Throws Error for negative or non-finite times.
    Shutter(const ShutterSettings& settings, int width, int height);

    /// Shutter for a larger frame that starts the given number of pixels before this one: pixels
    /// outside of this frame are exposed with the nearest line.
    Shutter within(int pixels_left, int pixels_above) const;

    /// From the first light on the first line to the last light on the last line.
    double duration_s() const { return duration_s_; }
    const ShutterSettings& settings() const { return settings_; }
    bool rolls() const { return line_ > 0; }
    /// Whether lines are columns of pixels.
    bool scans_columns() const {
        return settings_.scan == ScanOrder::left || settings_.scan == ScanOrder::right;
    }

    /// Opening time of the line through an image point (px), continuous between lines; clamped to
    /// the first and last line.
    double opens_at(Vec2d px) const;

    /// Samples a time for pixel (x, y) of the full frame from u in [0,1): with density s within the
    /// pixel's window. Leaf shutters sample uniformly, since the iris clips.
    Moment draw(int x, int y, float u) const;
    /// Samples a time independent of the pixel from u in [0,1). For rolling shutters the density is
    /// uniform: over all times if line windows overlap, otherwise over the union of the windows.
    Moment draw_any(float u) const;
    /// Density of draw_any() x exposure of a line for rolling shutters; otherwise 1.
    double any_share() const { return rolls() ? std::max(exposure_, 1.0 / lines_) : 1; }
    /// Weight of a sampled time: the mean of s; 1 for a leaf shutter.
    float weight() const { return settings_.leaf ? 1.f : float(settings_.curve.mean()); }
    /// Row (column, if columns are scanned) of an image point in a frame of the given size,
    /// clamped.
    int row_at(Vec2f px, int width, int height) const {
        return scans_columns() ? std::clamp(int(std::floor(px.x)), 0, width - 1)
                               : std::clamp(int(std::floor(px.y)), 0, height - 1);
    }
    /// s of a row (or column) at a time; for zero exposure, whether the time is its instant.
    float opening(int row, float time) const;

  private:
    /// Line of a row or column of the frame.
    int line_of(int i) const { return before_ < 0 ? i : std::clamp(i - before_, 0, lines_ - 1); }
    double open_of(double line) const { return line_ * (backward_ ? lines_ - 1 - line : line); }

    ShutterSettings settings_;
    double duration_s_ = 0;
    double exposure_ = 0, line_ = 0;   // fractions of the duration
    int lines_ = 1;
    int before_ = -1;   // number of lines of a larger frame before the first; < 0: no larger frame
    bool backward_ = false;
};

}  // namespace dg
