#include "render/flare/maps/sheet_pieces.h"

#include <algorithm>
#include <cmath>

#include "math/thread_scratch.h"
#include "render/flare/maps/coarse_light.h"
#include "render/flare/maps/color_table.h"

namespace dg {
namespace {

constexpr int kLooks = 32, kExactLooks = 16;
constexpr int kDeepest = 4;             // limit of subdivisions of a cell
constexpr float kNoSmaller = 0.75f;     // extent of a part's landings over the whole, above which division is useless
constexpr float kFarOff = 0.1f;         // weight of samples that land outside the frame, as neighbours may land inside
constexpr float kExactShare = 0.8f;     // factor for exact rays, which take longer than arrivals
constexpr float kSmallest = 12;         // least extent of a piece with an edge, in node spacings of the edge
constexpr double kUnseen = 0.05, kSurelyUnseen = 0.005;   // pseudo-counts of samples with light
constexpr double kPixel = 0.2, kBlock = 0.05;   // weights of the noise of pixels and of blocks
constexpr int kTests = 16;              // rays per cell that measure the error of its map
constexpr double kLeastWrong = 0.02;    // least error, as a fraction of the light
constexpr double kMoved = 0.75;         // error of light that lands a node spacing off, as a fraction
constexpr float kSeen[2] = {430, 650};  // nm: bounds of most visible light
constexpr float kGray = 0.25f;          // largest distance between wavelengths of a gray piece, in node spacings
constexpr float kSure = 0.5f;           // clip value over its range in the piece, above which light is blocked

/// Margin around the frame from which light may reach it, px.
const float kReach = CoarseLight::reach(SheetLevel::kMost);

}  // namespace

double area(const GhostMap& map, const SheetPiece& piece) {
    const double side = double(map.cells()[piece.cell].size) * piece.size;
    return side * side * map.region().area();
}

void draw_places(MapBatch& batch, const SheetPiece& piece, const SmallSource& source, const CellNumbers& u, int count) {
    for (int i = 0; i < count; ++i) {
        const SmallSource::Point& p = source.point(u.of[CellNumbers::kPoint][i]);
        const Vec2f at = piece.at({u.of[CellNumbers::kAcross][i], u.of[CellNumbers::kDown][i]});
        batch.set(i, at, p.shift, Wavelengths::sample(u.of[CellNumbers::kLambda][i]).nm[0], p.moment.iris_opening);
    }
}

std::vector<MapRay> rays_of(const GhostMap& map, const GhostMap::Cell& cell, const MapBatch& b, int count) {
    std::vector<MapRay> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({map.at(cell, {b.u[i], b.v[i]}), {b.shift_x[i], b.shift_y[i]}, b.nm[i]});
    return rays;
}

SheetPieces::SheetPieces(const MapRays& rays, const GhostMap& map, const SmallSource& source, const Sensor& sensor,
                         std::uint64_t key)
    : rays_(rays), map_(map), source_(source), sensor_(sensor), key_(key),
      smooth_(smoothness()), level_(map.crossings(), rays.ghosts(), sensor, source.filled, smooth_),
      spread_(map.cells().size(), -1.f), unseen_(map.cells().size()) {
    for (std::uint32_t c = 0; c < map.cells().size(); ++c) wrong_.push_back(map.cells()[c].exact ? 0.f : wrong(c));
    for (std::uint32_t c = 0; c < map.cells().size(); ++c) divide({c, {0, 0}, 1, 0}, 0, nullptr);
}

/// Smoothness by the light of cells that may reach the frame.
SheetSmooth SheetPieces::smoothness() const {
    std::vector<SheetSmooth::CellLight> cells;
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    for (std::uint32_t c = 0; c < map_.cells().size(); ++c) {
        const GhostMap::Cell& cell = map_.cells()[c];
        if (cell.exact) continue;
        draw(batch, {c, {0, 0}, 1, 0}, kTests);
        map_.landings(cell, batch, kTests);
        double light = 0;
        for (int i = 0; i < kTests; ++i)
            if (near({batch.x[i], batch.y[i]}, float(1 << SheetLevel::kMost)))
                light += seen_light(batch.nm[i]) * batch.pass[i];
        cells.push_back({&cell.blur, light * cell.size * cell.size});
    }
    return SheetSmooth::of(std::move(cells));
}

bool SheetPieces::near(Vec2f px, float reach) const {
    return px.x > -reach && px.y > -reach && px.x < float(sensor_.width) + reach &&
           px.y < float(sensor_.height) + reach;
}

/// Draws `count` points of a piece with source points, wavelengths and iris openings.
void SheetPieces::draw(MapBatch& batch, const SheetPiece& piece, int count) const {
    CellNumbers& u = thread_scratch<CellNumbers>([] {});
    u.fill(hash64(key_, piece.cell), 0, std::uint64_t(count));
    draw_places(batch, piece, source_, u, count);
}

/// Traces the exact rays of a batch.
std::vector<MapLanding> SheetPieces::trace(const MapBatch& batch, const GhostMap::Cell& cell, int count) const {
    return rays_.trace(rays_of(map_, cell, batch, count));
}

void SheetPieces::divide(const SheetPiece& piece, int depth, const Looked* whole) {
    const GhostMap::Cell& cell = map_.cells()[piece.cell];
    const int count = cell.exact ? kExactLooks : kLooks;
    const Looked looked = look(piece, count);
    const bool even = looked.lit == 0 || looked.lit == count;
    const bool spread = whole && extent(looked) > kNoSmaller * extent(*whole);   // division does not help
    if (even || spread || depth == kDeepest || is_small(piece, looked)) return keep(piece, count, looked, whole);
    for (int k = 0; k < 4; ++k) {
        const float half = 0.5f * piece.size;
        divide({piece.cell, piece.low + Vec2f{float(k % 2), float(k / 2)} * half, half, 0}, depth + 1, &looked);
    }
}

/// Longer side of the landings' bounds, px.
float SheetPieces::extent(const Looked& l) { return std::max(l.high.x - l.low.x, l.high.y - l.low.y); }

bool SheetPieces::is_small(const SheetPiece& piece, const Looked& looked) const {
    const float edge = level_.pitch(map_.cells()[piece.cell].blur);
    return extent(looked) < kSmallest * std::max(1.f, edge);
}

SheetPieces::Looked SheetPieces::look(const SheetPiece& piece, int count) const {
    Looked looked;
    map_.cells()[piece.cell].exact ? look_by_rays(piece, count, looked) : look_at_map(piece, count, looked);
    return looked;
}

void SheetPieces::look_at_map(const SheetPiece& piece, int count, Looked& to) const {
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    draw(batch, piece, count);
    map_.landings(map_.cells()[piece.cell], batch, count);
    for (int i = 0; i < count; ++i) {
        to.level += level_.of(map_.cells()[piece.cell].blur, batch, i) / float(count);
        const float seen = seen_light(batch.nm[i]);
        see(to, {batch.x[i], batch.y[i]}, seen * batch.glass[i], seen * batch.pass[i],
            rays_.stopped(batch.landing(i, map_.crossings())));
    }
}

void SheetPieces::look_by_rays(const SheetPiece& piece, int count, Looked& to) const {
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    draw(batch, piece, count);
    const std::vector<MapLanding> landings = trace(batch, map_.cells()[piece.cell], count);
    to.level = level_.of_rays();
    for (int i = 0; i < count; ++i) {
        const MapLanding& l = landings[i];
        const float seen = seen_light(batch.nm[i]);
        see(to, l.px, l.sound ? seen * l.pass : 0, seen * rays_.passed(l, batch.opening[i]), rays_.stopped(l));
    }
}

void SheetPieces::see(Looked& to, Vec2f px, float glass, float pass, float stop) const {
    to.lit += pass > 0;
    to.least_stop = std::min(to.least_stop, stop), to.most_stop = std::max(to.most_stop, stop);
    if (!(glass > 0)) return;
    to.low = {std::min(to.low.x, px.x), std::min(to.low.y, px.y)};
    to.high = {std::max(to.high.x, px.x), std::max(to.high.y, px.y)};
    const bool here = near(px, kReach);
    to.seen.push_back({px, here ? pass : 0, here ? glass : kFarOff * glass});
}

/// A stand-in sample at the center of the landings of the enclosing piece.
SheetPieces::Looked SheetPieces::in_the_dark(const Looked& whole) {
    Looked looked = whole;
    float most = 0;
    for (const Seen& s : whole.seen) most = std::max(most, s.open);
    looked.seen = {{0.5f * (whole.low + whole.high), 0, kFarOff * most}};
    return looked;
}

/// Whether the samples, with a margin for the piece's rim, land outside the frame.
bool SheetPieces::beside(const Looked& l) const {
    const Vec2f more = 0.5f * (l.high - l.low);
    return l.seen.empty() || l.high.x + more.x < -kReach || l.high.y + more.y < -kReach ||
           l.low.x - more.x > float(sensor_.width) + kReach || l.low.y - more.y > float(sensor_.height) + kReach;
}

/// Stores a piece. `whole`: samples of the enclosing piece. Cells without any light through the lens are treated like
/// areas without cells.
void SheetPieces::keep(SheetPiece piece, int count, Looked looked, const Looked* whole) {
    const bool sure = looked.lit == 0 && looked.least_stop > kSure * (looked.most_stop - looked.least_stop);
    if (looked.seen.empty() && !whole) unseen_[piece.cell] = true;
    if (looked.seen.empty() && whole) looked = in_the_dark(*whole);
    if (beside(looked)) return;
    piece.level = looked.level;
    double wrong = 0;
    if (!map_.cells()[piece.cell].exact) {
        const double apart = spread(piece.cell) * std::exp2(-double(piece.level));
        piece.gray = apart <= kGray;
        wrong = hypot(double(wrong_[piece.cell]), piece.gray ? 0.5 * kMoved * apart : 0);
    }
    pieces_.push_back(piece), looks_.push_back(count);
    doubt_.push_back({sure ? kSurelyUnseen : kUnseen, sure ? kLeastWrong : wrong});
    seen_.insert(seen_.end(), looked.seen.begin(), looked.seen.end());
    end_.push_back(seen_.size());
}

/// RMS difference between exact rays and the map: in light, or in position relative to the node spacing.
float SheetPieces::wrong(std::uint32_t c) const {
    const GhostMap::Cell& cell = map_.cells()[c];
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    draw(batch, {c, {0, 0}, 1, 0}, kTests);
    map_.landings(cell, batch, kTests);
    const std::vector<MapLanding> exact = trace(batch, cell, kTests);
    double squares = 0, light = 0;
    for (int i = 0; i < kTests; ++i) {
        const double seen = seen_light(batch.nm[i]);
        const double a = seen * batch.pass[i], b = seen * rays_.passed(exact[i], batch.opening[i]);
        const double moved = length(exact[i].px - Vec2f{batch.x[i], batch.y[i]}) * std::exp2(-level_.of(cell.blur, batch, i));
        squares += std::pow(a - b, 2) + a * b * std::pow(std::min(1.0, kMoved * moved), 2);
        light += std::max(a * a, b * b);
    }
    return float(std::max(kLeastWrong, std::sqrt((squares + kUnseen * light / kTests * 0.01) / std::max(light, 1e-30))));
}

/// Distance between landings of the ends of the visible spectrum, px, at the center of a cell and near its corners.
float SheetPieces::spread(std::uint32_t cell) {
    if (spread_[cell] >= 0) return spread_[cell];
    MapBatch& batch = thread_scratch<MapBatch>([] {});
    constexpr Vec2f kPlaces[] = {{0.5f, 0.5f}, {0.1f, 0.1f}, {0.9f, 0.1f}, {0.1f, 0.9f}, {0.9f, 0.9f}};
    int count = 0;
    for (const Vec2f at : kPlaces)
        for (const float nm : kSeen) batch.set(count++, at, {0, 0}, nm, 1);
    map_.landings(map_.cells()[cell], batch, count);
    for (int i = 0; i < count; i += 2)
        spread_[cell] = std::max(spread_[cell], hypot(batch.x[i] - batch.x[i + 1], batch.y[i] - batch.y[i + 1]));
    return spread_[cell];
}

void SheetPieces::add_to(FlareTiles& tiles, double times) const {
    std::size_t k = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        for (const double each = times * area(map_, pieces_[i]) / looks_[i]; k < end_[i]; ++k)
            tiles.add(seen_[k].px, each * seen_[k].light);
}

std::vector<SheetPiece> SheetPieces::weighed(const FlareTiles& tiles, double times) const {
    std::vector<SheetPiece> pieces;
    std::size_t k = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        double squares = 0, open = 0;
        for (; k < end_[i]; ++k) {
            const double importance = tiles.importance(seen_[k].px);
            squares += std::pow(seen_[k].light * importance, 2), open += std::pow(seen_[k].open * importance, 2);
        }
        const double rms = std::sqrt((squares + doubt_[i].unseen / looks_[i] * open) / looks_[i]);
        if (!(rms > 0)) continue;
        pieces.push_back(pieces_[i]);
        SheetPiece& piece = pieces.back();
        const double pitch2 = std::exp2(2 * double(piece.level));
        const double each = times * area(map_, piece) * std::sqrt(kPixel / pitch2 + kBlock);
        piece.share = each * rms * (map_.cells()[piece.cell].exact ? kExactShare : 1);
        piece.doubt = each * doubt_[i].wrong * std::sqrt(open / looks_[i]);
    }
    return pieces;
}

}  // namespace dg
