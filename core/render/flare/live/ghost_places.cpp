#include "render/flare/live/ghost_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/byte_writer.h"
#include "camera/lens_key.h"
#include "math/portable.h"
#include "render/flare/live/drawn_ghosts.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kSteps = 12;         // angle steps from the axis to the frame's corner
constexpr double kNearness = 0.0025;  // step of the nearness of a source, front radius over distance
constexpr double kDim = 3e-4;         // limit of the share of dropped ghosts at an angle
constexpr double kArrivals = 4e5;     // arrivals of all ghosts of a picture
constexpr std::size_t kMostAngles = 64;

/// Angle from the axis and nearness of a source, relative to the center of the front.
struct Seen {
    double angle, turn, nearness;
    Seen(const ExactLens::Ball& front, const MapSource& source) {
        const Vec3d to = source.at_infinity ? source.middle : source.middle - front.center;
        const double across = hypot(to.x, to.y);
        angle = atan2(across, -to.z), turn = across > 0 ? atan2(to.y, to.x) : 0;
        nearness = source.at_infinity ? 0 : front.radius / length(to);
    }
};

/// A white point source.
LiveSource white(const MapSource& shape) {
    SmallSource small{0, shape, {}, false, 0};
    small.points.push_back({{0, 0}, {1, 1, 1}, {}, {}});
    return {std::move(small), 1};
}

}  // namespace

bool GhostPlaces::can_keep(const Camera& camera) {
    return camera.lens_motion.times.empty() && std::get<ExactLens>(camera.lens).is_axial();
}

double GhostPlaces::turn_of(const Camera& camera, const MapSource& source) {
    return Seen(std::get<ExactLens>(camera.lens).front_ball(), source).turn;
}

bool GhostPlaces::set_lens(const Camera& camera, const Sensor& sensor) {
    const auto& lens = std::get<ExactLens>(camera.lens);
    const Vec2f shift = setting_at(camera, 0.5f).film_shift_mm;
    const SensorStack& stack = camera.sensor_stack;
    ByteWriter w;
    w(sensor.width, sensor.height, sensor.width_mm, sensor.height_mm, sensor.center_mm.x, sensor.center_mm.y, shift.x, shift.y);
    w(stack.cover_thickness, stack.cover_index, stack.cover_gap, stack.cover_coating, stack.reflectance);
    std::string key = lens_key(lens.tracer().prescription(), lens.settings()) + w.bytes;
    rays_ = 0;
    if (key == lens_) return true;
    lens_ = std::move(key);
    const double far = hypot(std::abs(sensor.center_mm.x + shift.x) + 0.5 * sensor.width_mm,
                             std::abs(sensor.center_mm.y + shift.y) + 0.5 * sensor.height_mm);
    const auto square = [far](double pitch) { return int(std::ceil(2 * far / pitch)); };
    const double pitch_x = sensor.width_mm / sensor.width, pitch_y = sensor.height_mm / sensor.height;
    frame_.width = square(pitch_x), frame_.height = square(pitch_y);
    frame_.width_mm = frame_.width * pitch_x, frame_.height_mm = frame_.height * pitch_y;
    frame_.center_mm = {-shift.x, -shift.y};
    step_rad_ = atan(far / std::abs(lens.first_order().efl)) / kSteps;
    return false;
}

std::vector<std::optional<KnownGhost>> GhostPlaces::of(const FlareAim& aim, const MapSource& source, int threads) {
    const Seen seen(std::get<ExactLens>(aim.camera().lens).front_ball(), source);
    const double place = seen.angle / step_rad_;
    const int angle = int(place), near = int(std::lround(seen.nearness / kNearness));
    const auto first = at(aim, angle, near, threads), second = at(aim, angle + 1, near, threads);
    std::vector<std::optional<KnownGhost>> known(std::size_t(aim.pairs()));
    for (std::size_t i = 0; i < known.size(); ++i)
        if ((*first)[i] || (*second)[i]) known[i].emplace((*first)[i], (*second)[i], float(place - angle));
    return known;
}

GhostPlaces::Places GhostPlaces::at(const FlareAim& aim, int angle, int near, int threads) {
    const Key key{lens_, angle, near};
    auto kept = angles_.find(key);
    if (kept == angles_.end()) {
        Places found = find(aim, angle, near, threads);   // throws if it was cancelled
        if (angles_.size() == kMostAngles)
            angles_.erase(std::ranges::min_element(angles_, {}, [](const auto& a) { return a.second.used; }));
        kept = angles_.emplace(key, Angle{std::move(found)}).first;
    }
    kept->second.used = ++uses_;
    return kept->second.places;
}

GhostPlaces::Places GhostPlaces::find(const FlareAim& aim, int angle, int near, int threads) {
    const ExactLens::Ball front = std::get<ExactLens>(aim.camera().lens).front_ball();
    const double from_axis = angle * step_rad_;
    MapSource shape;
    shape.middle = {std::sin(from_axis), 0, -std::cos(from_axis)}, shape.at_infinity = near == 0;
    if (near > 0) shape.middle = front.center + (front.radius / (near * kNearness)) * shape.middle;
    const LiveSource source = white(shape);
    std::vector<DrawnGhost> ghosts = ghosts_of(aim, source, frame_, nullptr, threads);
    for (const DrawnGhost& g : ghosts) rays_ += g.ghost->rays();
    const double worth = choose(ghosts, frame_, kDim);
    auto places = std::make_shared<std::vector<std::shared_ptr<const GhostPlace>>>(std::size_t(aim.pairs()));
    parallel_tasks(threads, std::int64_t(ghosts.size()), [&](std::int64_t i) {
        DrawnGhost& g = ghosts[std::size_t(i)];
        (*places)[std::size_t(g.pair)] = std::make_shared<const GhostPlace>(g.ghost->place(kArrivals, g.worth / worth));
    });
    return places;
}

}  // namespace dg
