#include "light/light_profile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "light/emitter_check.h"
#include "math/error.h"

namespace dg {
namespace {

constexpr double kTwoPiD = 2 * kPiD;
constexpr const char* kWhere = "light profile";
constexpr double kLongestStep = kPiD / 180;   // rad: largest step of the quadrature
constexpr int kMostSteps = 20000;             // limit for narrow foci
// Limits of knots and cells of the quadrature, for arbitrarily fine tables from files.
constexpr std::size_t kMostThetas = 32768, kLeastPhis = 64, kMostCells = 1 << 20;
// Three-point Gauss-Legendre rule on [-1, 1], exact to degree 5.
constexpr double kPoints[] = {-0.7745966692414834, 0, 0.7745966692414834};
constexpr double kWeights[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

void want(bool good, const char* what, const char* wanted, double got) {
    if (!good) throw input_error(kWhere, what, wanted, std::to_string(got));
}

/// Checks for ascending numbers in 0 .. most.
void check_angles(const std::vector<float>& angles, const char* what, float most) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
        want(angles[i] >= 0 && angles[i] <= most, what, "angles within the sphere", angles[i]);
        if (i > 0) want(angles[i] > angles[i - 1], what, "rising angles", angles[i]);
    }
}

void check(const ProfileTable& t) {
    want(!t.theta.empty(), "theta", "at least one angle", 0);
    want(!t.phi.empty(), "phi", "at least one angle", 0);
    check_angles(t.theta, "theta", kPi);
    check_angles(t.phi, "phi", 2 * kPi);
    if (t.phi.size() > 1) {
        want(t.phi.front() == 0, "phi", "0 as the first angle", t.phi.front());
        want(t.phi.back() == 2 * kPi, "phi", "2 pi as the last angle", t.phi.back());
    }
    want(t.values.size() == t.theta.size() * t.phi.size(), "values", "one for each pair of angles",
         double(t.values.size()));
    for (const float v : t.values) want(std::isfinite(v) && v >= 0, "values", "finite values >= 0", v);
}

void check(const ProfileParts& parts) {
    want(std::isfinite(parts.scale) && parts.scale >= 0, "scale", "a finite number >= 0", parts.scale);
    for (const ProfileCone& c : parts.cones) {
        want(c.angle > 0 && c.angle <= kPi, "cone: angle", "0 < angle <= pi", c.angle);
        want(c.softness >= 0 && c.softness <= 1, "cone: softness", "0 .. 1", c.softness);
    }
    for (const ProfileFocus& f : parts.focuses) {
        want(std::isfinite(f.exponent) && f.exponent >= 0, "focus", "a finite exponent >= 0", f.exponent);
        check_color(kWhere, "focus tint", f.tint);
    }
    for (const ProfileTable& t : parts.tables) check(t);
}

/// Interval and fraction of a value in ascending knots.
struct KnotInterval {
    std::size_t left, right;
    float share;
};
KnotInterval place_in(const std::vector<float>& knots, float v) {
    if (knots.size() == 1) return {0, 0, 0};
    const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, v);
    const std::size_t right = std::size_t(after - knots.begin());
    return {right - 1, right, std::clamp((v - knots[right - 1]) / (knots[right] - knots[right - 1]), 0.f, 1.f)};
}

float mix(float a, float b, float share) { return a * (1 - share) + b * share; }

/// Angle from the axis beyond which a table is 0.
float end_of(const ProfileTable& t) {
    const std::size_t columns = t.phi.size();
    for (std::size_t i = t.theta.size(); i-- > 0;)
        for (std::size_t k = 0; k < columns; ++k)
            if (t.values[i * columns + k] > 0) return t.theta[std::min(i + 1, t.theta.size() - 1)];
    return 0;
}

void sort_unique(std::vector<double>& knots) {
    std::ranges::sort(knots);
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
}

/// Divides intervals that are longer than `step`.
std::vector<double> divided(const std::vector<double>& knots, double step) {
    std::vector<double> all;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double span = knots[i + 1] - knots[i];
        const int n = std::max(1, int(std::ceil(span / step)));
        for (int k = 0; k < n; ++k) all.push_back(knots[i] + span * k / n);
    }
    all.push_back(knots.back());
    return all;
}

/// Knots, or uniform steps if there are too many.
std::vector<double> thinned(std::vector<double> knots, std::size_t most) {
    if (knots.size() <= most) return knots;
    const double end = knots.back();
    knots.resize(most);
    for (std::size_t i = 0; i < most; ++i) knots[i] = end * double(i) / double(most - 1);
    return knots;
}

float largest(const ProfileTable& t) { return *std::ranges::max_element(t.values); }

}  // namespace

float ProfileCone::at(float theta) const {
    if (theta > angle) return 0;
    const float start = angle * (1 - softness);
    if (theta <= start || softness == 0) return 1;
    const float t = (theta - start) / (angle - start);
    return 1 - t * t * (3 - 2 * t);
}

Rgb ProfileFocus::at(float cosine) const {
    const float factor = std::pow(std::abs(cosine), exponent);
    return tint * (1 - factor) + Rgb{factor, factor, factor};
}

float ProfileTable::at(float to_theta, float to_phi) const {
    if (to_theta < theta.front() || to_theta > theta.back()) return 0;
    const KnotInterval row = place_in(theta, to_theta), column = place_in(phi, to_phi);
    const auto along = [&](std::size_t r) {
        const float* v = values.data() + r * phi.size();
        return mix(v[column.left], v[column.right], column.share);
    };
    return mix(along(row.left), along(row.right), row.share);
}

LightProfile::LightProfile(ProfileParts parts) : parts_(std::move(parts)) {
    check(parts_);
    for (const ProfileCone& cone : parts_.cones) spread_ = std::min(spread_, cone.angle);
    for (const ProfileTable& table : parts_.tables) spread_ = std::min(spread_, end_of(table));
    measure();
    want(std::isfinite(peak_), "values", "products that are finite", peak_);
}

Rgb LightProfile::at(float theta, float phi) const {
    float factor = parts_.scale;
    for (const ProfileCone& cone : parts_.cones) factor *= cone.at(theta);
    for (const ProfileTable& table : parts_.tables) factor *= table.at(theta, phi);
    Rgb all{factor, factor, factor};
    if (factor > 0)
        for (const ProfileFocus& focus : parts_.focuses) all = all * focus.at(std::cos(theta));
    return all;
}

Rgb LightProfile::at(Vec3f local) const {
    const float theta = atan2(std::sqrt(local.x * local.x + local.y * local.y), -local.z);
    if (parts_.tables.empty()) return at(theta, 0);
    const float phi = atan2(local.y, local.x);
    return at(theta, phi < 0 ? phi + 2 * kPi : phi);
}

/// Angles between which the profile is smooth, at distances suitable for the quadrature.
std::vector<double> LightProfile::theta_knots() const {
    std::vector<double> knots{0, kPiD / 2, kPiD};
    double step = kLongestStep;
    for (const ProfileCone& c : parts_.cones) knots.insert(knots.end(), {c.angle, double(c.angle) * (1 - c.softness)});
    for (const ProfileTable& t : parts_.tables) knots.insert(knots.end(), t.theta.begin(), t.theta.end());
    for (const ProfileFocus& f : parts_.focuses)   // similar to a Gaussian of width 1 / sqrt(exponent)
        step = std::min(step, std::max(0.2 / std::sqrt(f.exponent + 1.0), kPiD / kMostSteps));
    std::erase_if(knots, [](double k) { return k > kPiD; });
    sort_unique(knots);
    return thinned(divided(knots, step), kMostThetas);
}

std::vector<double> LightProfile::phi_knots(std::size_t thetas) const {
    std::vector<double> knots{0, kTwoPiD};
    for (const ProfileTable& t : parts_.tables) knots.insert(knots.end(), t.phi.begin(), t.phi.end());
    std::erase_if(knots, [](double k) { return k > kTwoPiD; });
    sort_unique(knots);
    return thinned(std::move(knots), std::max(kLeastPhis, kMostCells / thetas));
}

/// Upper bound of all factors.
float LightProfile::bound() const {
    float most = parts_.scale;
    for (const ProfileTable& table : parts_.tables) most *= largest(table);
    for (const ProfileFocus& focus : parts_.focuses) most *= std::max(1.f, max_component(focus.tint));
    return most;
}

/// Computes means by Gauss-Legendre quadrature between knots, and the maximum over knots.
void LightProfile::measure() {
    const std::vector<double> thetas = theta_knots(), phis = phi_knots(thetas.size());
    Vec3d mean{}, facing{};
    for (std::size_t i = 0; i < thetas.size(); ++i) {
        for (const double phi : phis) peak_ = std::max(peak_, max_component(at(float(thetas[i]), float(phi))));
        if (i + 1 == thetas.size() || thetas[i] > double(spread_)) continue;
        const double half = (thetas[i + 1] - thetas[i]) / 2;
        for (int a = 0; a < 3; ++a) {
            const double theta = thetas[i] + half * (1 + kPoints[a]);
            Vec3d ring{};
            for (std::size_t k = 0; k + 1 < phis.size(); ++k) {
                const double half_phi = (phis[k + 1] - phis[k]) / 2;
                for (int b = 0; b < 3; ++b) {
                    const double phi = phis[k] + half_phi * (1 + kPoints[b]);
                    ring += to_double(at(float(theta), float(phi))) * (half_phi * kWeights[b]);
                }
            }
            mean += ring * (half * kWeights[a] * std::sin(theta));
            facing += ring * (half * kWeights[a] * std::sin(theta) * std::max(0.0, std::cos(theta)));
        }
    }
    if (thetas.size() == kMostThetas || phis.size() == std::max(kLeastPhis, kMostCells / thetas.size()))
        peak_ = std::max(peak_, bound());   // uniform steps may have missed the peak
    mean_ = to_float(mean * (1 / (4 * kPiD)));
    facing_mean_ = to_float(facing * (1 / kPiD));
}

LampAxes::LampAxes(const Affine3d& m) {
    const auto unit = [](Vec3d v, Vec3d otherwise) {
        const double l = length(v);
        return l > 0 ? v * (1 / l) : otherwise;
    };
    const Vec3d c = unit(m.z, {0, 0, 1});
    const Frame aside = Frame::from_normal(to_float(c));
    const Vec3d a = unit(m.x - c * dot(m.x, c), to_double(aside.x));
    const double side = dot(cross(c, a), m.y) < 0 ? -1 : 1;
    x = to_float(a), y = to_float(cross(c, a) * side), z = to_float(c);
}

LampAxes::LampAxes(const Quaternionf& rotation, bool mirrored)
    : x(rotation.rotate({1, 0, 0})), y(rotation.rotate({0, mirrored ? -1.f : 1.f, 0})), z(rotation.rotate({0, 0, 1})) {}

LampShape::LampShape(std::int32_t profile, const Affine3d& world_from_local) : profile(profile) {
    const LampAxes axes(world_from_local);
    const Vec3f y = cross(axes.z, axes.x);
    mirrored = dot(y, axes.y) < 0;
    const Quaterniond q = from_matrix(Affine3d{to_double(axes.x), to_double(y), to_double(axes.z), {}});
    rotation = {float(q.x), float(q.y), float(q.z), float(q.w)};
}

LampShape blend(const LampShape& a, const LampShape& b, float share) {
    LampShape between = a;
    if (a.used()) between.rotation = slerp(a.rotation, b.rotation, share);
    return between;
}

}  // namespace dg
