#include "render/flare/highlight_survey.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "render/flare/glints.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr int kAcross = 16, kDown = 8;   // tiles
constexpr int kCells = 4;                // per tile along each axis: about 5 degrees
constexpr int kWide = 64;                // paths per cell in the first look
constexpr int kClose = 512;              // paths of a closer look
constexpr int kMostLooks = 9;
constexpr float kSpread = 0.5f;          // rad: initial cone of lamps in mirrors
constexpr float kSharper = 0.4f;         // factor on the cone in each closer look
constexpr int kGrid = 16, kPerCell = 4;  // resolution of a spot, and paths per cell
constexpr std::size_t kMostSpots = 48;
constexpr double kHot = 8;               // ratio to the mean above which a cell is a spot
constexpr double kPeak = 16;             // ratio to the mean of a single path above which there may be a spot
constexpr double kMoves = 0.1;           // fraction of the variance that a significant motion explains
constexpr float kBright = 0.1f;          // fraction of a spot's luminance above which a cell belongs to it
constexpr float kLeast = 0.1f;           // fraction of the mean: lower bound of sampling weights in a spot or tile
constexpr int kTileSequence = -6, kSpotSequence = -16;   // in place of a pixel row

struct SurveyRay {
    Ray ray;
    float luminance;
    int cell;
};

/// Bounding rectangle of points.
struct Extent {
    Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};
    int count = 0;
    void add(Vec2f p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        ++count;
    }
};

/// Uniform distribution over cells.
Distribution2D even(int cells) {
    return {cells, cells, std::vector<float>(std::size_t(cells) * cells, 1.f)};
}

/// Raises weights to a minimum, as few paths have sampled each cell.
std::vector<float> raised(std::vector<float> weights, int cells, float mean) {
    std::vector<float> out(weights.size());
    for (int r = 0; r < cells; ++r)
        for (int c = 0; c < cells; ++c) {
            float around = 0;
            for (int y = std::max(r - 1, 0); y <= std::min(r + 1, cells - 1); ++y)
                for (int x = std::max(c - 1, 0); x <= std::min(c + 1, cells - 1); ++x)
                    around += weights[std::size_t(y) * cells + x];
            float& own = out[std::size_t(r) * cells + c];
            own = std::max(weights[std::size_t(r) * cells + c] + 0.05f * around, kLeast * mean);
        }
    return out;
}

class Surveyor {
  public:
    Surveyor(const Scene& scene, const EmitterPoints& lamps, const SurveyView& view)
        : scene_(scene), view_(view), glints_(scene, lamps) {
        view_.path.visible_emitters = view_.path.caustics = false;
        tiles_ = direction_tiles(kAcross, kDown);
    }

    Survey run() {
        look_around();
        if (!(mean_ > 0)) return {{}, rays_};
        std::vector<HighlightSpot> spots = hot_cells();
        parallel_tasks(view_.threads, std::int64_t(spots.size()),
                       [&](std::int64_t i) { close_in(spots[i], int(i)); });
        spots = worth_it(std::move(spots));
        std::vector<HighlightTile> tiles;
        for (std::size_t i = 0; i < tiles_.size(); ++i)
            if (auto tile = rest(i, spots)) tiles.push_back(std::move(*tile));
        return {Highlights(std::move(spots), std::move(tiles)), rays_};
    }

  private:
    /// Samples a path, with enlarged lamps in mirrors; empty where no light enters.
    template <typename Toward>
    std::optional<SurveyRay> look(const Toward& toward, PathSampler& sampler, float spread, std::uint64_t& rays) const {
        const CameraRandom u = sampler.camera();
        const Moment moment = view_.shutter.draw_any(u.time);
        const auto ray = view_.ray(toward(u.film, moment.time), {2 * u.lens.x - 1, 2 * u.lens.y - 1}, moment.time);
        if (!ray) return std::nullopt;
        const Wavelengths wavelengths = Wavelengths::sample(u.lambda);
        Wavelengths own = wavelengths;
        const Radiance light = radiance(scene_, *ray, own, sampler, view_.path, nullptr, &rays);
        float y = wavelengths.to_xyz(light.sum()).y;
        if (spread > 0 && !glints_.empty()) y += glints_.seen(*ray, spread, wavelengths, sampler, rays);
        return SurveyRay{*ray, std::isfinite(y) ? std::max(y, 0.f) : 0.f, 0};
    }

    void look_around();
    std::vector<HighlightSpot> hot_cells() const;
    std::vector<SurveyRay> looks_at(const HighlightSpot& spot, int count, int sequence, float spread);
    void close_in(HighlightSpot& spot, int index);
    std::vector<HighlightSpot> worth_it(std::vector<HighlightSpot> spots);
    bool learn(HighlightSpot& spot, std::span<const HighlightSpot> before, int sequence);
    std::optional<HighlightTile> rest(std::size_t tile, std::span<const HighlightSpot> spots) const;
    Vec2f velocity(const HighlightSpot& spot, std::span<const SurveyRay> looks) const;
    float nearness(const HighlightSpot& spot, std::span<const SurveyRay> looks) const;

    const Scene& scene_;
    SurveyView view_;
    Glints glints_;
    std::vector<DirectionTile> tiles_;
    std::vector<std::vector<SurveyRay>> looks_;   // per tile
    double mean_ = 0;                        // mean luminance of directions from which light enters
    std::atomic<std::uint64_t> rays_{0};
};

void Surveyor::look_around() {
    constexpr int kCount = kWide * kCells * kCells;
    looks_.resize(tiles_.size());
    parallel_tasks(view_.threads, std::int64_t(tiles_.size()), [&](std::int64_t t) {
        std::uint64_t rays = 0;
        for (int i = 0; i < kCount; ++i) {
            PathSampler sampler(int(t), kTileSequence, std::uint32_t(i), 0);
            int cell = 0;
            const auto toward = [&](Vec2f u, float) {
                cell = int(u.y * kCells) * kCells + int(u.x * kCells);
                return EmitterPoint{{.position = tiles_[t].at(u)}, true};
            };
            if (auto found = look(toward, sampler, kSpread, rays)) {
                found->cell = cell;
                looks_[t].push_back(*found);
            }
        }
        rays_ += rays;
    });
    double sum = 0, area = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        for (const SurveyRay& l : looks_[t])
            sum += l.luminance * tiles_[t].solid_angle(), area += tiles_[t].solid_angle();
    mean_ = area > 0 ? sum / area : 0;
}

/// Bright cells, by decreasing brightness.
std::vector<HighlightSpot> Surveyor::hot_cells() const {
    std::vector<HighlightSpot> spots;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        std::array<double, kCells * kCells> light{};
        std::array<int, kCells * kCells> count{};
        std::array<float, kCells * kCells> peak{};
        for (const SurveyRay& l : looks_[t]) {
            light[l.cell] += l.luminance, ++count[l.cell];
            peak[l.cell] = std::max(peak[l.cell], l.luminance);
        }
        for (int c = 0; c < kCells * kCells; ++c) {
            if (!(light[c] > kHot * mean_ * count[c]) && !(peak[c] > kPeak * mean_)) continue;
            const auto direction = [&](float x, float y) {
                return tiles_[t].at({(float(c % kCells) + x) / kCells, (float(c / kCells) + y) / kCells});
            };
            HighlightSpot spot{view_.anchor, Frame::from_normal(direction(0.5f, 0.5f))};
            Extent extent;
            for (int k = 0; k < 9; ++k)
                if (const auto at = spot.meet(
                        {view_.anchor, direction(1.25f * float(k % 3) * 0.5f - 0.125f,
                                                 1.25f * float(k / 3) * 0.5f - 0.125f)}))
                    extent.add(*at);
            spot.low = extent.low, spot.size = extent.high - extent.low;
            spot.luminance = light[c] / count[c];
            spots.push_back(std::move(spot));
        }
    }
    std::ranges::stable_sort(spots, std::ranges::greater{}, [](const HighlightSpot& s) {
        return s.luminance * s.solid_angle();
    });
    if (spots.size() > kMostSpots) spots.resize(kMostSpots);
    return spots;
}

/// Uniform samples of a spot's rectangle.
std::vector<SurveyRay> Surveyor::looks_at(const HighlightSpot& spot, int count, int sequence, float spread) {
    HighlightSpot evenly = spot;
    evenly.weights = even(1);
    std::vector<SurveyRay> looks;
    std::uint64_t rays = 0;
    for (int i = 0; i < count; ++i) {
        PathSampler sampler(sequence, kSpotSequence, std::uint32_t(i), 0);
        int cell = 0;
        const auto toward = [&](Vec2f u, float time) {
            cell = int(u.y * kGrid) * kGrid + int(u.x * kGrid);
            return evenly.sample(u, time);
        };
        if (auto found = look(toward, sampler, spread, rays)) {
            found->cell = cell;
            looks.push_back(*found);
        }
    }
    rays_ += rays;
    return looks;
}

/// Inverse distance of the plane on which the spot has the least parallax between points of the front, by least
/// squares.
float Surveyor::nearness(const HighlightSpot& spot, std::span<const SurveyRay> looks) const {
    HighlightSpot far = spot, near = spot;
    far.nearness = 0, near.nearness = 1;
    double sum = 0, a[2]{}, b[2]{}, ab = 0, bb = 0;
    for (const SurveyRay& l : looks) {
        const auto s = far.meet(l.ray), moved = near.meet(l.ray);
        if (!s || !(l.luminance > 0)) continue;
        const Vec2f by = *moved - *s;
        const double w = l.luminance;
        sum += w, a[0] += w * s->x, a[1] += w * s->y, b[0] += w * by.x, b[1] += w * by.y;
        ab += w * (double(s->x) * by.x + double(s->y) * by.y);
        bb += w * (double(by.x) * by.x + double(by.y) * by.y);
    }
    if (!(sum > 0)) return 0;
    ab -= (a[0] * b[0] + a[1] * b[1]) / sum, bb -= (b[0] * b[0] + b[1] * b[1]) / sum;
    if (!(bb > 0)) return 0;
    // Excludes images inside the glass; distant images are at infinity for a lens.
    const float best = std::clamp(float(-ab / bb), 0.f, 0.5f / view_.radius);
    return best * view_.radius < 1e-5f ? 0 : best;
}

/// Velocity of the spot on its plane, by least squares.
Vec2f Surveyor::velocity(const HighlightSpot& spot, std::span<const SurveyRay> looks) const {
    HighlightSpot still = spot;
    still.velocity = {};
    double sum = 0, t = 0, tt = 0, x = 0, y = 0, tx = 0, ty = 0, squares = 0;
    for (const SurveyRay& l : looks) {
        const auto s = still.meet(l.ray);
        if (!s) continue;
        const double w = l.luminance, time = l.ray.time;
        sum += w, t += w * time, tt += w * time * time;
        squares += w * (double(s->x) * s->x + double(s->y) * s->y);
        x += w * s->x, y += w * s->y, tx += w * time * s->x, ty += w * time * s->y;
    }
    if (!(sum > 0)) return spot.velocity;
    const double spread = tt - t * t / sum;
    if (!(spread > 1e-6 * sum)) return {};   // an exposure of length 0
    const double vx = (tx - t * x / sum) / spread, vy = (ty - t * y / sum) / spread;
    const double explained = (vx * vx + vy * vy) * spread, variance = squares - (x * x + y * y) / sum;
    if (explained < kMoves * variance) return {};
    return {float(vx), float(vy)};
}

/// Shrinks a spot's rectangle to its bright part in closer looks.
void Surveyor::close_in(HighlightSpot& spot, int index) {
    float spread = kSpread;
    for (int i = 0; i < kMostLooks; ++i, spread *= kSharper) {
        const std::vector<SurveyRay> looks = looks_at(spot, kClose, index * 16 + i, spread);
        double light = 0, squares = 0;
        for (const SurveyRay& l : looks) light += l.luminance, squares += double(l.luminance) * l.luminance;
        if (!(light > 0)) return;
        const double least = kBright * squares / light;
        std::vector<SurveyRay> bright;
        for (const SurveyRay& l : looks)
            if (l.luminance > least) bright.push_back(l);
        HighlightSpot closer = spot;
        closer.velocity = velocity(spot, bright);
        closer.nearness = nearness(closer, bright);
        Extent extent;
        for (const SurveyRay& l : bright)
            if (const auto at = closer.meet(l.ray)) extent.add(*at);
        if (extent.count < 2) return;
        const Vec2f size = extent.high - extent.low;
        const float step = 1.5f / std::sqrt(float(kClose)), more = 0.05f + 2 / float(extent.count);
        const Vec2f margin{more * size.x + step * spot.size.x, more * size.y + step * spot.size.y};
        closer.low = extent.low - margin, closer.size = size + margin * 2.f;
        if (!(closer.solid_angle() < 0.7 * spot.solid_angle())) {
            if (i > 3) return;   // earlier looks may fail to shrink it because lamps are enlarged
            continue;
        }
        spot = closer;
    }
}

/// Spots that are bright without the light that earlier spots contain.
std::vector<HighlightSpot> Surveyor::worth_it(std::vector<HighlightSpot> spots) {
    std::vector<char> keep(spots.size());
    parallel_tasks(view_.threads, std::int64_t(spots.size()), [&](std::int64_t i) {
        keep[i] = learn(spots[i], std::span(spots).first(std::size_t(i)), int(i) * 16 + kMostLooks);
    });
    std::vector<HighlightSpot> kept;
    for (std::size_t i = 0; i < spots.size(); ++i)
        if (keep[i]) kept.push_back(std::move(spots[i]));
    return kept;
}

bool Surveyor::learn(HighlightSpot& spot, std::span<const HighlightSpot> before, int sequence) {
    std::vector<float> weights(std::size_t(kGrid) * kGrid);
    double sum = 0;
    for (const SurveyRay& l : looks_at(spot, kGrid * kGrid * kPerCell, sequence, 0)) {
        if (held(before, l.ray)) continue;
        weights[l.cell] += l.luminance / kPerCell, sum += l.luminance;
    }
    const double mean = sum / (kGrid * kGrid * kPerCell);
    if (!(mean > 0.5 * kHot * mean_)) return false;
    weights = raised(std::move(weights), kGrid, float(mean));
    spot.weights = Distribution2D(kGrid, kGrid, weights);
    spot.luminance = spot.weights.integral();
    return true;
}

/// The remainder of a tile without its spots.
std::optional<HighlightTile> Surveyor::rest(std::size_t tile, std::span<const HighlightSpot> spots) const {
    if (looks_[tile].empty()) return std::nullopt;
    std::vector<float> weights(kCells * kCells);
    double sum = 0;
    for (const SurveyRay& l : looks_[tile]) {
        if (held(spots, l.ray)) continue;
        weights[l.cell] += l.luminance / kWide, sum += l.luminance;
    }
    // A cell with dark samples may contain light elsewhere.
    const double mean = std::max(sum / (kWide * kCells * kCells), 1e-3 * mean_);
    HighlightTile rest{tiles_[tile], Distribution2D(kCells, kCells, raised(weights, kCells, float(mean)))};
    rest.luminance = rest.weights.integral();
    return rest;
}

}  // namespace

Survey survey_highlights(const Scene& scene, const EmitterPoints& lamps, const SurveyView& view) {
    if (scene.triangle_count() == 0) return {};
    return Surveyor(scene, lamps, view).run();
}

}  // namespace dg
