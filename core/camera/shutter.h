// shutter.h -- when which part of the film is exposed, and how much of the light passes then.
//
// A point of the film is exposed for `exposure_s`; u in [0,1] runs through that time, and the opening
// s(u) in 0..1 is the share of the light that passes. A frame is H/H0 with the shutter fully open: what
// is shut away while it opens and closes darkens the picture by mean(s), its efficiency.
// A shutter that scans exposes one line of pixels after the other, line_time_s apart.
// Inside the renderer, time is the fraction of the scene's interval [0, duration_s].
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace dg {

/// s(u), piecewise linear; two points of one u are a jump.
class OpeningCurve {
  public:
    /// Open from 0 to 1 (box).
    OpeningCurve();
    /// Opens and closes evenly, with mean 1/2 (never rests) to 1 (box).
    static OpeningCurve trapezoid(double efficiency);
    /// Points (u, s), 2 to 4096 of them, u not falling within [0,1], s >= 0; scaled so that the largest is
    /// 1; shut before the first and after the last. Throws Error.
    static OpeningCurve points(std::span<const double> u, std::span<const double> s);

    double at(double u) const;
    double mean() const { return area_.back(); }
    /// u drawn with density s(u) / mean, from r in [0,1).
    double sample(double r) const { return box_ ? r : draw(r); }
    std::span<const double> places() const { return u_; }
    std::span<const double> values() const { return s_; }

  private:
    OpeningCurve(std::vector<double> u, std::vector<double> s);
    double draw(double r) const;
    std::vector<double> u_, s_, area_;   // area_[i]: integral of s up to u_[i]
    bool box_;                           // as it is most of the time: nothing to invert
};

/// The side of the upright picture that is exposed first; none: all at once.
enum class ScanOrder { none, top, bottom, left, right };

struct ShutterSettings {
    double exposure_s = 0;       // of a point of the film, from the first light to the last
    OpeningCurve curve;
    ScanOrder scan = ScanOrder::none;
    double line_time_s = 0;      // between neighbouring lines of pixels
    bool leaf = false;           // the iris itself opens: `curve` is its radius, 1 = as set by the f-stop
};

/// When a sample is taken, and how far the iris is open then (a fraction of its radius).
struct Moment {
    float time = 0;
    float iris_opening = 1;
};

class Shutter {
  public:
    /// At rest: a single instant.
    Shutter() = default;
    /// For a frame of so many pixels. Throws Error for times that are negative or not finite.
    Shutter(const ShutterSettings& settings, int width, int height);

    /// The same for a larger frame around this one, which begins so many pixels before it: what lies beside
    /// this one is exposed with the line that is nearest.
    Shutter within(int pixels_left, int pixels_above) const;

    /// From the first light on the first line to the last on the last one.
    double duration_s() const { return duration_s_; }
    const ShutterSettings& settings() const { return settings_; }
    bool rolls() const { return line_ > 0; }
    /// Whether lines are columns of pixels.
    bool scans_columns() const {
        return settings_.scan == ScanOrder::left || settings_.scan == ScanOrder::right;
    }

    /// When the line through a point of the picture (px) opens, without steps from line to line; points
    /// outside are held to the first and last.
    double opens_at(Vec2d px) const;

    /// The time of a sample of pixel (x, y) of the full frame, from u in [0,1): with density s within the
    /// pixel's window. A leaf's is even: its iris decides what passes.
    Moment draw(int x, int y, float u) const;
    /// The time of a sample of no pixel in particular, from u in [0,1). Of lines that roll, with even density:
    /// over all times if two are ever open at once, else over the times at which one is.
    Moment draw_any(float u) const;
    /// Share of draw_any(), where lines roll: density x exposure of one line; 1 where they do not.
    double any_share() const { return rolls() ? std::max(exposure_, 1.0 / lines_) : 1; }
    /// Weight of a sample that is drawn like this: the mean of s; 1 for a leaf.
    float weight() const { return settings_.leaf ? 1.f : float(settings_.curve.mean()); }
    /// Row of a frame of so many pixels (column, if those are scanned) at a place, or the nearest.
    int row_at(Vec2f px, int width, int height) const {
        return scans_columns() ? std::clamp(int(std::floor(px.x)), 0, width - 1)
                               : std::clamp(int(std::floor(px.y)), 0, height - 1);
    }
    /// s of a row (of a column, if those are scanned) at a time; of an exposure of no length, whether this
    /// is its instant.
    float opening(int row, float time) const;

  private:
    /// The line of a row or column of the frame.
    int line_of(int i) const { return before_ < 0 ? i : std::clamp(i - before_, 0, lines_ - 1); }
    double open_of(double line) const { return line_ * (backward_ ? lines_ - 1 - line : line); }

    ShutterSettings settings_;
    double duration_s_ = 0;
    double exposure_ = 0, line_ = 0;   // fractions of the duration
    int lines_ = 1;
    int before_ = -1;   // lines of a larger frame before the first; < 0: it is this one
    bool backward_ = false;
};

}  // namespace dg
