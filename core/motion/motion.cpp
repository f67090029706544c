#include "motion/motion.h"

#include <cmath>

#include "math/error.h"
#include "motion/decompose.h"
#include "motion/keyed.h"

namespace dg {
namespace {

constexpr double kConstant = 1e-10;  // relative change of stretches below which it counts as rounding
constexpr double kRigid = 1e-5;   // largest stretch that twist accepts as rounding

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

/// M = R S for the interpolation; empty: interpolate linearly.
std::optional<RotationStretch> split(const Affine3d& m, Interpolation how, std::size_t key) {
    const auto where = [&] { return "motion key " + std::to_string(key); };
    switch (how) {
        case Interpolation::linear: return std::nullopt;
        case Interpolation::decomposed: return polar(m);
        case Interpolation::slerp: {
            auto parts = scaled_rotation(m);
            if (!parts)
                throw input_error(where(), "slerp", "columns at right angles, none of them 0",
                                  "a matrix with shear or without inverse (use 'decomposed' for shear)");
            return parts;
        }
        case Interpolation::twist: {
            auto parts = polar(m);
            if (!parts || !is_one(parts->stretch))
                throw input_error(where(), "twist", "a rigid matrix",
                                  "a matrix that scales, shears or mirrors (use 'decomposed')");
            parts->stretch = Affine3d{};
            return parts;
        }
    }
    return std::nullopt;
}

struct CosineSine {
    double cosine, sine;
};

/// For small angles, truncated series are exact to rounding and faster; panning cameras evaluate
/// them for every ray.
CosineSine cosine_sine(double angle) {
    const double x2 = angle * angle;
    if (x2 > 1.0 / 64) return {std::cos(angle), std::sin(angle)};
    const double c = 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56 * (1 - x2 / 90))));
    const double s = 1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72)));
    return {c, angle * s};
}

/// M(angle) p = base rot(axis, angle) stretch (p - about), for a linear base.
Motion::Turn turn_about(const Affine3d& base, Vec3d axis, const Affine3d& stretch, Vec3d about) {
    Motion::Turn turn;
    for (Vec3d Affine3d::*column : {&Affine3d::x, &Affine3d::y, &Affine3d::z}) {
        const Vec3d v = stretch.*column, along = axis * dot(axis, v);
        turn.mean.*column = base.vector(along);
        turn.cosine.*column = base.vector(v - along);
        turn.sine.*column = base.vector(cross(axis, v));
    }
    for (Affine3d* part : {&turn.mean, &turn.cosine, &turn.sine})
        part->origin = -part->vector(about);
    return turn;
}

/// Whether the motion from one key to the next rotates.
bool turns_to(const Motion::Segment& from, const Motion::Segment& to) {
    return from.turns && to.turns && from.first.determinant() * to.first.determinant() > 0;
}

/// Sets rotation and change of the segment from one key to the next.
void lead_to(Motion::Segment& from, const Motion::Segment& to, Vec3d pivot) {
    if (!from.turns) {
        from.change = difference(to.first, from.first);
        return;
    }
    const Affine3d growth = difference(to.stretch, from.stretch);
    from.stretches = spectral_norm(growth) > kConstant * spectral_norm(from.stretch);
    if (from.stretches) from.change = growth;
    from.change.origin = to.first.point(pivot) - from.first.point(pivot);
    Quaterniond delta = from.rotation.conjugate() * to.rotation;   // R0^-1 R1
    if (delta.w < 0) delta = -delta;
    const Vec3d v{delta.x, delta.y, delta.z};
    const double sine = length(v);
    from.angle = 2 * atan2(sine, delta.w);
    if (sine > 0) from.axis = v / sine;
    const Affine3d rotation = to_matrix(from.rotation);
    from.turn = from.stretches ? turn_about(rotation, from.axis, {}, {})
                               : turn_about(rotation, from.axis, from.stretch, pivot);
}

}  // namespace

Affine3d Motion::Turn::at(double angle) const {
    const auto [c, s] = cosine_sine(angle);
    return {mean.x + cosine.x * c + sine.x * s, mean.y + cosine.y * c + sine.y * s,
            mean.z + cosine.z * c + sine.z * s, mean.origin + cosine.origin * c + sine.origin * s};
}

Affine3d Motion::Segment::stretch_at(double s) const {
    return {stretch.x + change.x * s, stretch.y + change.y * s, stretch.z + change.z * s, {}};
}

Affine3d Motion::Segment::at(double s, Vec3d pivot) const {
    if (s == 0) return first;
    if (!turns) return moved(first, change, s);
    Affine3d m = turn.at(angle * s);
    if (stretches) {
        m = m * stretch_at(s);
        m.origin = -m.vector(pivot);
    }
    m.origin += first.point(pivot) + change.origin * s;
    return m;
}

Motion::Motion(Track track) {
    const bool moves = track.segments.size() > 1 || track.spins();
    still_ = track.segments.front().first;
    track.spun_first = turn_about(still_, track.spin.axis, {}, track.spin.center);
    track.spun_first.mean.origin += still_.point(track.spin.center);
    if (moves) track_ = std::make_shared<const Track>(std::move(track));
}

Motion::Track Motion::track_or_still() const {
    if (track_) return *track_;
    Track track;
    track.times = {0};
    track.segments.resize(1);
    track.segments[0].first = still_;
    return track;
}

Motion Motion::keys(std::span<const double> times, std::span<const Affine3d> keys,
                    Interpolation how, Vec3d pivot) {
    if (keys.empty() || times.size() != keys.size())
        throw input_error("motion", "keys", "one matrix for each time",
                          std::to_string(times.size()) + " times, " + std::to_string(keys.size()) +
                              " matrices");
    Track track;
    track.times.assign(times.begin(), times.end());
    track.segments.resize(keys.size());
    track.pivot = pivot;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(times[i]) || !is_finite(keys[i]))
            throw input_error("motion key " + std::to_string(i), "numbers", "finite numbers",
                              "NaN or infinity");
        if (i > 0 && !(times[i] >= times[i - 1]))
            throw input_error("motion key " + std::to_string(i), "time", "times that do not decrease",
                              std::to_string(times[i - 1]) + " then " + std::to_string(times[i]));
        Segment& segment = track.segments[i];
        segment.first = keys[i];
        if (const auto parts = split(keys[i], how, i)) {
            segment.turns = true;
            segment.rotation = parts->rotation;
            segment.stretch = parts->stretch;
        }
    }
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        track.segments[i].turns = turns_to(track.segments[i], track.segments[i + 1]);
        lead_to(track.segments[i], track.segments[i + 1], pivot);
    }
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

Motion Motion::relative_to(Vec3d world_origin, Vec3d local_origin) const {
    Track track = track_or_still();
    for (Segment& segment : track.segments) segment.first.origin = segment.first.point(local_origin) - world_origin;
    track.pivot = track.pivot - local_origin, track.spin.center = track.spin.center - local_origin;
    for (std::size_t i = 0; i + 1 < track.segments.size(); ++i)
        lead_to(track.segments[i], track.segments[i + 1], track.pivot);
    return Motion(std::move(track));
}

Affine3d Motion::Track::at(double time) const {
    if (segments.size() == 1) return spins() ? spun_first.at(spin_angle(time)) : segments[0].first;
    const KeyPlace place = place_among(times, time);
    const Affine3d base = segments[place.left].at(place.share, pivot);
    return spins() ? base * spun(time) : base;
}

/// Reduces by whole turns, because sines of large angles lose precision.
double Motion::Track::spin_angle(double time) const {
    const double turns = spin.revolutions_per_second * (time - spin.time);
    return 2 * kPiD * (turns - std::floor(turns));
}

Affine3d Motion::Track::spun(double time) const {
    Affine3d turn = to_matrix(Quaterniond::from_axis_angle(spin.axis, spin_angle(time)));
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
    const std::size_t end = std::min(last + (on_key ? 1 : 2), times.size());   // including the key after `close`
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
