#include "camera/shutter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr std::size_t kMostPoints = 4096;

}  // namespace

OpeningCurve::OpeningCurve() : OpeningCurve({0, 1}, {1, 1}) {}

OpeningCurve::OpeningCurve(std::vector<double> u, std::vector<double> s)
    : u_(std::move(u)), s_(std::move(s)), area_(u_.size()) {
    for (std::size_t i = 1; i < u_.size(); ++i)
        area_[i] = area_[i - 1] + 0.5 * (s_[i - 1] + s_[i]) * (u_[i] - u_[i - 1]);
    box_ = area_.back() == 1;
}

OpeningCurve OpeningCurve::trapezoid(double efficiency) {
    if (!(efficiency >= 0.5 && efficiency <= 1))
        throw input_error("shutter", "efficiency", "0.5 .. 1", std::to_string(efficiency));
    const double ramp = 1 - efficiency;
    return {{0, ramp, 1 - ramp, 1}, {0, 1, 1, 0}};
}

OpeningCurve OpeningCurve::points(std::span<const double> u, std::span<const double> s) {
    if (u.size() != s.size() || u.size() < 2 || u.size() > kMostPoints)
        throw input_error("shutter", "curve", "2 to 4096 points (time, opening)",
                          std::to_string(u.size()));
    double largest = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        const std::string where = "curve, point " + std::to_string(i);
        if (!(u[i] >= 0 && u[i] <= 1 && (i == 0 || u[i] >= u[i - 1])))
            throw input_error("shutter", where, "times within 0 .. 1 that do not decrease",
                              std::to_string(u[i]));
        if (!(s[i] >= 0 && std::isfinite(s[i])))
            throw input_error("shutter", where, "an opening of at least 0", std::to_string(s[i]));
        largest = std::max(largest, s[i]);
    }
    std::vector<double> scaled(s.begin(), s.end());
    for (double& value : scaled) value /= largest;
    OpeningCurve curve({u.begin(), u.end()}, std::move(scaled));
    if (!(largest > 0 && curve.mean() > 0))
        throw Error("shutter: curve: never open");
    return curve;
}

double OpeningCurve::at(double u) const {
    if (u < u_.front() || u > u_.back()) return 0;
    const std::size_t i =
        std::max<std::size_t>(1, std::lower_bound(u_.begin(), u_.end(), u) - u_.begin());
    const double length = u_[i] - u_[i - 1];
    return length > 0 ? s_[i - 1] + (s_[i] - s_[i - 1]) * (u - u_[i - 1]) / length : s_[i];
}

// Within a segment the density is linear from a to b, so its CDF is quadratic; this form of the
// root is numerically stable: x = r (a + b) / (a + sqrt(a^2 (1 - r) + b^2 r)). Source: Pharr,
// Jakob, Humphreys, Physically Based Rendering, 4th ed., section 2.3.2.
double OpeningCurve::draw(double r) const {
    const double wanted = r * mean();
    const auto above = std::upper_bound(area_.begin(), area_.end(), wanted);
    const std::size_t i = std::min<std::size_t>(above - area_.begin(), area_.size() - 1);
    const double a = s_[i - 1], b = s_[i], share = area_[i] - area_[i - 1];
    const double rest = share > 0 ? (wanted - area_[i - 1]) / share : 0;
    if (!(rest > 0)) return u_[i - 1];
    const double x = rest * (a + b) / (a + std::sqrt(a * a * (1 - rest) + b * b * rest));
    return u_[i - 1] + std::min(x, 1.0) * (u_[i] - u_[i - 1]);
}

Shutter::Shutter(const ShutterSettings& settings, int width, int height) : settings_(settings) {
    const auto check = [](const char* what, double value) {
        if (!(value >= 0 && std::isfinite(value)))
            throw input_error("shutter", what, "s, at least 0", std::to_string(value));
    };
    check("exposure", settings.exposure_s);
    check("line time", settings.line_time_s);
    const bool scans = settings.scan != ScanOrder::none;
    if (width < 1 || height < 1)
        throw input_error("shutter", "resolution", "at least 1 x 1 px",
                          std::to_string(width) + " x " + std::to_string(height));
    if (scans && settings.leaf) throw Error("shutter: a leaf shutter exposes all lines at once, without a scan");
    lines_ = !scans ? 1 : scans_columns() ? width : height;
    backward_ = settings.scan == ScanOrder::bottom || settings.scan == ScanOrder::right;
    duration_s_ = settings.exposure_s + (lines_ - 1) * settings.line_time_s;
    if (!(duration_s_ > 0)) return;
    exposure_ = settings.exposure_s / duration_s_;
    if (scans) line_ = settings.line_time_s / duration_s_;
}

Shutter Shutter::within(int pixels_left, int pixels_above) const {
    Shutter larger = *this;
    larger.before_ = scans_columns() ? pixels_left : pixels_above;
    return larger;
}

double Shutter::opens_at(Vec2d px) const {
    const double line = (scans_columns() ? px.x : px.y) - 0.5 - std::max(0, before_);   // line centres
    return line_ > 0 ? open_of(std::clamp(line, 0.0, lines_ - 1.0)) : 0;
}

Moment Shutter::draw(int x, int y, float u) const {
    if (settings_.leaf) return {float(exposure_ * u), float(settings_.curve.at(u))};
    const double open = line_ > 0 ? open_of(line_of(scans_columns() ? x : y)) : 0;
    return {float(open + exposure_ * settings_.curve.sample(u))};
}

Moment Shutter::draw_any(float u) const {
    if (!rolls()) return draw(0, 0, u);
    if (exposure_ > line_) return {u};
    const double line = std::min(std::floor(double(u) * lines_), lines_ - 1.0);
    return {float(open_of(line) + exposure_ * (double(u) * lines_ - line))};
}

float Shutter::opening(int row, float time) const {
    row = line_of(row);
    if (row < 0 || row >= lines_) return 0;
    const double open = open_of(row);
    if (!(exposure_ > 0)) return time == float(open) ? 1.f : 0.f;
    // Accept times that were sampled in this window, despite rounding to float.
    const double u = (time - open) / exposure_, slack = 1.2e-7 / exposure_;
    if (u < -slack || u > 1 + slack) return 0;
    return float(settings_.curve.at(std::clamp(u, 0.0, 1.0)));
}

}  // namespace dg
