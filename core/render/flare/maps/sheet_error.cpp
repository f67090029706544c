#include "render/flare/maps/sheet_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "render/flare/maps/color_table.h"
#include "render/parallel.h"

namespace dg {
namespace {

constexpr double kRays = 1 << 17, kDarkRays = 1 << 15;

/// Light on a coarse grid with bilinear weights, so that small shifts of landings cause small differences.
class Grid {
  public:
    explicit Grid(const Sensor& sensor)
        : pitch_(std::max(1.f, float(std::max(sensor.width, sensor.height)) / kAcross)),
          columns_(int(float(sensor.width) / pitch_) + 2), rows_(int(float(sensor.height) / pitch_) + 2),
          light_(std::size_t(columns_) * rows_) {}

    void add(Vec2f px, double light) {
        const float x = px.x / pitch_, y = px.y / pitch_;
        if (!(x >= 0 && y >= 0 && x < float(columns_ - 1) && y < float(rows_ - 1))) return;
        const int column = int(x), row = int(y);
        const double fx = x - float(column), fy = y - float(row);
        double* const at = &light_[std::size_t(row) * columns_ + column];
        at[0] += light * (1 - fx) * (1 - fy), at[1] += light * fx * (1 - fy);
        at[columns_] += light * (1 - fx) * fy, at[columns_ + 1] += light * fx * fy;
    }
    void add(const Grid& other) {
        for (std::size_t i = 0; i < light_.size(); ++i) light_[i] += other.light_[i];
    }
    std::size_t count() const { return light_.size(); }
    double light(std::size_t i) const { return light_[i]; }
    Vec2f place(std::size_t i) const { return Vec2f{float(int(i) % columns_), float(int(i) / columns_)} * pitch_; }
    double area() const { return double(pitch_) * pitch_; }

  private:
    static constexpr float kAcross = 64;
    float pitch_;   // px
    int columns_, rows_;
    std::vector<double> light_;
};

/// Light of rays minus light of maps, in two independent halves: the mean of their product is the squared error without
/// the variance of the estimate.
using Difference = std::array<Grid, 2>;

class Tester {
  public:
    Tester(const FlareSheets& sheets, std::size_t index, const Sensor& sensor)
        : difference{Grid(sensor), Grid(sensor)}, sheet_(sheets.sheets()[index]),
          source_(sheets.sources()[std::size_t(sheet_.source)]), luminance_(source_.luminance()), key_(index),
          dark_(int(kDarkRays / double(sheets.sheets().size())) + 1) {}

    void test() {
        for (std::size_t i = 0; i < sheet_.pieces.size(); ++i) test(sheet_.pieces[i], i);
        test_dark();
    }
    Difference difference;

  private:
    void add(std::uint64_t half, Vec2f px, double light) {
        difference[half & 1].add(px, light);
    }
    void test(const SheetPiece& piece, std::size_t index);
    void test_dark();

    const FlareSheets::Sheet& sheet_;
    const SmallSource& source_;
    double luminance_;
    std::uint64_t key_;
    int dark_;
    MapBatch batch_{};
    CellNumbers u_;
};

/// Tests a piece with rays in proportion to its light.
void Tester::test(const SheetPiece& piece, std::size_t index) {
    const GhostMap::Cell& cell = sheet_.map.cells()[piece.cell];
    if (cell.exact) return;
    const std::uint64_t seed = hash64(key_ + 1, index);
    const double rate = kRays * piece.share, each = luminance_ * area(sheet_.map, piece) / rate;
    const auto all = std::uint64_t(std::floor(rate + hash_uniform(seed, 0)));
    u_.each(seed, 0, all, [&](std::uint64_t first, int count) {
        draw_places(batch_, piece, source_, u_, count);
        sheet_.map.landings(cell, batch_, count);
        const std::vector<MapLanding> exact = sheet_.rays.trace(rays_of(sheet_.map, cell, batch_, count));
        for (int i = 0; i < count; ++i) {
            const std::uint64_t half = hash64(seed, first + std::uint64_t(i));
            const double light = each * seen_light(batch_.nm[i]);
            add(half, {batch_.x[i], batch_.y[i]}, -light * batch_.pass[i]);
            add(half, exact[i].px, light * sheet_.rays.passed(exact[i], batch_.opening[i]));
        }
    });
}

/// Tests points where the map has no light.
void Tester::test_dark() {
    u_.each(hash64(key_, ~0ull), 0, std::uint64_t(dark_), [&](std::uint64_t, int count) {
        std::vector<MapRay> rays;
        std::vector<float> opening;
        for (int i = 0; i < count; ++i) {
            const SmallSource::Point& p = source_.point(u_.of[CellNumbers::kPoint][i]);
            const Vec2f at{2 * u_.of[CellNumbers::kAcross][i] - 1, 2 * u_.of[CellNumbers::kDown][i] - 1};
            if (!sheet_.is_dark(at)) continue;
            rays.push_back({at, p.shift, Wavelengths::sample(u_.of[CellNumbers::kLambda][i]).nm[0]});
            opening.push_back(p.moment.iris_opening);
        }
        const std::vector<MapLanding> exact = sheet_.rays.trace(rays);
        for (std::size_t i = 0; i < rays.size(); ++i)
            add(i, exact[i].px,
                luminance_ * 4 / dark_ * seen_light(rays[i].nm) * sheet_.rays.passed(exact[i], opening[i]));
    });
}

/// RMS over grid points relative to the light of each; halves with different signs cancel.
double error_of(const Difference& d, const FlareTiles& tiles) {
    const double mean = tiles.mean() / tiles.area() * d[0].area();   // per grid point
    double sum = 0;
    for (std::size_t i = 0; i < d[0].count(); ++i) {
        const double per_light = tiles.importance(d[0].place(i)) / mean;
        sum += 4 * d[0].light(i) * d[1].light(i) * per_light * per_light;   // each half has half of the rays
    }
    return std::sqrt(std::max(0.0, sum / double(d[0].count())));
}

}  // namespace

SheetErrors sheet_errors(const FlareSheets& sheets, const FlareTiles& tiles, const RenderSettings& settings) {
    const std::size_t count = sheets.sheets().size();
    SheetErrors errors{0, std::vector<double>(count)};
    if (!(tiles.mean() > 0)) return errors;
    std::vector<std::optional<Difference>> of_sheet(count);
    parallel_tasks(settings.threads, std::int64_t(count), [&](std::int64_t i) {
        const auto tester = std::make_unique<Tester>(sheets, std::size_t(i), settings.sensor);
        tester->test();
        errors.of_sheet[i] = error_of(tester->difference, tiles);
        of_sheet[i] = std::move(tester->difference);
    });
    Difference all{Grid(settings.sensor), Grid(settings.sensor)};
    for (const auto& d : of_sheet)
        for (int h = 0; h < 2; ++h) all[h].add((*d)[h]);
    errors.all = error_of(all, tiles);
    return errors;
}

}  // namespace dg
