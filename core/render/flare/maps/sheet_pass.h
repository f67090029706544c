// sheet_pass.h -- ghosts of small sources from maps: a large number of cheap interpolated arrivals, and a small number
// of exact rays that correct the maps. E[map] + E[exact - map] = E[exact], so the result is unbiased for any map, with
// low noise for accurate maps (a two-level multilevel estimator; Heinrich 2001, Giles 2015, arXiv 1304.5472).
//
// Light of a ghost that the source's size blurs over many pixels is splatted to nodes a fifth of the blur apart
// (coarse_light.h); light of a sharp ghost, to nodes at the pixels.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "render/flare/flare_guide.h"
#include "render/flare/maps/cell_color.h"
#include "render/flare/maps/cell_numbers.h"
#include "render/flare/maps/coarse_light.h"
#include "render/pass.h"

namespace dg {

class SheetPass final : public Pass {
  public:
    /// Draws the sample indices [begin, end) of `indices`. `per_sample`: flare paths per index, each equivalent to
    /// kArrivals arrivals. `per_count`: indices per unit of the density's counts.
    SheetPass(const Picture& picture, std::array<double, 2> indices, double per_sample, double per_count,
              std::shared_ptr<const FlareGuide> guide);

    std::int64_t count() const override { return std::int64_t(tasks_.size()); }
    void draw(std::int64_t block) override;
    void finish(int threads) override;
    RenderCounters counters() const override;

  private:
    using Sheet = FlareSheets::Sheet;
    /// Estimators of a cell: the map, exact rays minus the map, exact rays alone, and exact rays where no cell is.
    enum class Kind { map, difference, exact, dark };
    /// Pieces [first, last) of a sheet.
    struct Task {
        std::size_t sheet;
        std::uint32_t first, last;
    };
    /// Light of the map to subtract from an exact ray.
    struct Taken {
        Vec2f px;
        FilmColor light;
    };
    /// An exact ray to trace, with its light.
    struct Exact {
        MapRay ray;
        const SmallSource::Point* from;
        float u_lambda;
        FilmColor light;         // without occlusion and clipping
        int level;
        Taken map{};
    };
    struct Work {
        MapBatch batch{};
        CellNumbers numbers;
        std::optional<CellColor> color;    // cached from the previous piece, as pieces of a cell are consecutive
        std::pair<const GhostMap::Cell*, bool> color_of{};
        std::vector<const SmallSource::Point*> from;
        std::vector<Exact> exact;
        std::array<std::vector<CoarseLight::Arrival>, SheetLevel::kMost + 1> arrivals;   // per level
        std::size_t arrived = 0;   // number of arrivals
        RenderCounters counters;
    };
    struct Range {
        std::uint64_t seed, first, last;
    };

    void plan();
    Range range(Kind kind, std::size_t sheet, std::uint32_t piece, double rate) const;
    /// Arrivals per sample index.
    double rate(Kind kind, const SheetPiece& piece) const;
    /// Light of an arrival, for an unoccluded source of light 1.
    float weight(double area, double rate) const;
    void draw_piece(Work& work, std::size_t sheet, std::uint32_t piece);
    void draw_map(Work& work, const Sheet& sheet, const SheetPiece& piece, const Range& range, float weight);
    void draw_difference(Work& work, const Sheet& sheet, const SheetPiece& piece, const Range& range, float weight);
    void draw_exact(Work& work, const Sheet& sheet, const SheetPiece& piece, const Range& range, float weight);
    Exact& add_exact(Work& work, const Sheet& s, Vec2f at, int i, float weight) const;
    void draw_dark(Work& work, std::size_t sheet);
    void trace(Work& work, const Sheet& sheet);
    void flush(Work& work);
    float seen(Work& work, const Sheet& sheet, const MapRay& ray, const SmallSource::Point& from, float u_lambda) const;
    float exposed(const SmallSource& source, const SmallSource::Point& from, Vec2f px) const;
    void arrive(Work& work, int level, Vec2f px, const FilmColor& light, const Taken* map = nullptr);
    SheetLevel levels(const Sheet& s) const {
        return {s.map.crossings(), s.rays.ghosts(), picture_.settings.sensor, source(s).filled, s.smooth};
    }
    const CellColor& color_of(Work& work, const Sheet& sheet, const SheetPiece& piece) const;
    const SmallSource& source(const Sheet& s) const { return guide_->sheets().sources()[std::size_t(s.source)]; }

    Picture picture_;
    std::array<double, 2> indices_;
    double per_sample_, per_count_;
    std::shared_ptr<const FlareGuide> guide_;
    FilmDensity density_;
    CellColors colors_;
    float unit_;                     // light of a pixel per light and unit area of the square
    std::vector<Task> tasks_;
    std::array<std::unique_ptr<CoarseLight>, SheetLevel::kMost + 1> coarse_;   // per level
    oneapi::tbb::enumerable_thread_specific<std::unique_ptr<Work>> works_;
};

}  // namespace dg
