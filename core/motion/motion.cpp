#include "motion/motion.h"

#include <cmath>

#include "math/error.h"
#include "motion/decompose.h"
#include "motion/keyed.h"

namespace dg {
namespace {

constexpr double kRigid = 1e-5;   // largest stretch that twist takes for rounding

bool is_finite(const Affine3d& m) {
    for (const Vec3d v : {m.x, m.y, m.z, m.origin})
        if (!std::isfinite(v.x + v.y + v.z)) return false;
    return true;
}

Affine3d difference(const Affine3d& b, const Affine3d& a) {
    return {b.x - a.x, b.y - a.y, b.z - a.z, b.origin - a.origin};
}
bool same(const Affine3d& a, const Affine3d& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.origin == b.origin;
}
Affine3d moved(const Affine3d& m, const Affine3d& change, double s) {
    return {m.x + change.x * s, m.y + change.y * s, m.z + change.z * s,
            m.origin + change.origin * s};
}

bool is_one(const Affine3d& stretch) {
    const Affine3d d = difference(stretch, Affine3d{});
    return length(d.x) + length(d.y) + length(d.z) < kRigid;
}

/// M = R S by the law of the interpolation; empty: there is none, and the way is linear.
std::optional<RotationStretch> split(const Affine3d& m, Interpolation how, std::size_t key) {
    const auto where = [&] { return "motion key " + std::to_string(key); };
    switch (how) {
        case Interpolation::linear: return std::nullopt;
        case Interpolation::decomposed: return polar(m);
        case Interpolation::slerp: {
            auto parts = scaled_rotation(m);
            if (!parts)
                throw input_error(where(), "slerp", "columns at right angles, none of them 0",
                                  "a matrix with shear or without inverse; 'decomposed' takes shear");
            return parts;
        }
        case Interpolation::twist: {
            auto parts = polar(m);
            if (!parts || !is_one(parts->stretch))
                throw input_error(where(), "twist", "a rigid matrix",
                                  "one that scales, shears or mirrors; 'decomposed' takes those");
            parts->stretch = Affine3d{};
            return parts;
        }
    }
    return std::nullopt;
}

/// How the way to the next key turns, and what it changes.
void lead_to(Motion::Segment& from, const Motion::Segment& to) {
    if (!from.turns || !to.turns || from.first.determinant() * to.first.determinant() < 0) {
        from.turns = false;
        from.change = difference(to.first, from.first);
        return;
    }
    from.path_change = to.path - from.path;
    from.stretch_change = difference(to.stretch, from.stretch);
    Quaterniond delta = from.rotation.conjugate() * to.rotation;   // R0^-1 R1: the lecture's twist
    if (delta.w < 0) delta = -delta;
    const Vec3d v{delta.x, delta.y, delta.z};
    const double sine = length(v);
    from.angle = 2 * std::atan2(sine, delta.w);
    if (sine > 0) from.axis = v / sine;
}

}  // namespace

Affine3d Motion::Segment::at(double s, Vec3d pivot) const {
    if (s == 0) return first;
    if (!turns) return moved(first, change, s);
    const Affine3d r = to_matrix(rotation * Quaterniond::from_axis_angle(axis, angle * s));
    Affine3d m = r * moved(stretch, stretch_change, s);
    m.origin = path + path_change * s - m.vector(pivot);
    return m;
}

Motion::Motion(Track track) {
    const bool moves = track.segments.size() > 1 || track.spins();
    still_ = track.segments.front().first;
    if (moves) track_ = std::make_shared<const Track>(std::move(track));
}

Motion::Track Motion::track_or_still() const {
    if (track_) return *track_;
    Track track{{0}, std::vector<Segment>(1), {}, {}};
    track.segments[0].first = still_;
    return track;
}

Motion Motion::keys(std::span<const double> times, std::span<const Affine3d> keys,
                    Interpolation how, Vec3d pivot) {
    if (keys.empty() || times.size() != keys.size())
        throw input_error("motion", "keys", "one matrix for each time",
                          std::to_string(times.size()) + " times, " + std::to_string(keys.size()) +
                              " matrices");
    Track track{{times.begin(), times.end()}, std::vector<Segment>(keys.size()), pivot, {}};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(times[i]) || !is_finite(keys[i]))
            throw input_error("motion key " + std::to_string(i), "numbers", "finite ones",
                              "NaN or infinity");
        if (i > 0 && !(times[i] >= times[i - 1]))
            throw input_error("motion key " + std::to_string(i), "time", "times that rise",
                              std::to_string(times[i - 1]) + " then " + std::to_string(times[i]));
        Segment& segment = track.segments[i];
        segment.first = keys[i];
        if (const auto parts = split(keys[i], how, i)) {
            segment.turns = true;
            segment.rotation = parts->rotation;
            segment.stretch = parts->stretch;
            segment.path = keys[i].point(pivot);
        }
    }
    for (std::size_t i = 0; i + 1 < keys.size(); ++i)
        lead_to(track.segments[i], track.segments[i + 1]);
    return Motion(std::move(track));
}

Motion Motion::spinning(const Spin& spin) const {
    const double size = length(spin.axis);
    if (!(size > 0) ||
        !std::isfinite(size + length(spin.center) + spin.revolutions_per_second + spin.time))
        throw input_error("spin", "axis, center, speed", "finite numbers and an axis that is not 0",
                          "axis length " + std::to_string(size));
    Track track = track_or_still();
    track.spin = spin;
    track.spin.axis = spin.axis / size;
    return Motion(std::move(track));
}

Affine3d Motion::Track::at(double time) const {
    const KeyPlace place = place_among(times, time);
    const Affine3d base = segments[place.left].at(place.share, pivot);
    return spins() ? base * spun(time) : base;
}

Affine3d Motion::Track::spun(double time) const {
    // Whole turns are taken off first: the sine of a large angle has lost its digits.
    const double turns = spin.revolutions_per_second * (time - spin.time);
    const double angle = 2 * kPiD * (turns - std::floor(turns));
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle(spin.axis, angle));
    turn.origin = spin.center - turn.vector(spin.center);
    return turn;
}

Motion Motion::over(double open, double close) const {
    const double span = close - open;
    if (!track_ || !(span > 0)) return Motion(at(open));
    Track part = *track_;
    const std::vector<double>& times = track_->times;
    const std::size_t first = place_among(times, open).left, last = place_among(times, close).left;
    const bool on_key = last > first && times[last] == close;
    const std::size_t end = std::min(last + (on_key ? 1 : 2), times.size());   // the key behind too
    part.times.assign(times.begin() + first, times.begin() + end);
    part.segments.assign(track_->segments.begin() + first, track_->segments.begin() + end);
    for (double& t : part.times) t = (t - open) / span;
    const auto rests = [&](const Segment& s) { return same(s.first, part.segments[0].first); };
    if (times[first] >= close || std::ranges::all_of(part.segments, rests)) {
        part.times = {0};
        part.segments.resize(1);
    }
    part.spin.revolutions_per_second *= span;
    part.spin.time = (part.spin.time - open) / span;
    return Motion(std::move(part));
}

}  // namespace dg
