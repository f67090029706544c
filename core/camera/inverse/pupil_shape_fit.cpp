// pupil_shape_fit.cpp -- set-up of PupilShape from camera rays.
#include <algorithm>
#include <cmath>

#include "camera/inverse/pupil_probe.h"
#include "camera/inverse/pupil_rim.h"
#include "camera/inverse/pupil_shape.h"
#include "math/hash.h"

namespace dg {
namespace {

// Margins for rays between the sampled rays. Cells of lenses without axial symmetry hold fewer
// rays, and image-shaped irises have no known rim.
constexpr float kMargin = 1.03f, kWideMargin = 1.05f;
constexpr int kFew = 300;    // records below which a cell also uses its neighbours'
constexpr int kFewest = 24;  // records below which a corner's oval is interpolated
constexpr double kOverlap = 0.2;  // overlap of cells, in cells
constexpr double kSteepest =
    0.1;  // least cosine between a ray and the line from the pupil's centre
constexpr int kRounds = 3;

}  // namespace

PupilShape::PupilShape(const ExactLens& lens)
    : lens_(lens),
      axial_(lens.is_axial()),
      pupil_{0, 0, lens.pupil_offset_m()},
      columns_(axial_ ? 16 : 8),
      rows_(axial_ ? 0 : 8),
      layers_(axial_ ? 5 : 3),
      angles_(layers_ + 1),
      ovals_(std::size_t(columns_ + 1) * (rows_ + 1) * (layers_ + 1)),
      cells_(std::size_t(columns_) * std::max(rows_, 1) * layers_) {
    const std::vector<Record> records = look_back(lens);
    bound_angles(records);
    fit_ovals(records);
    fit_cells(records);
}

/// Records for a point on every ray, in every layer of nearness.
std::vector<PupilShape::Record> PupilShape::look_back(const ExactLens& lens) {
    const std::vector<CameraRay> rays = probe_pupil(lens, axial_);
    nearest_ = 1e9;
    for (const CameraRay& r : rays)
        nearest_ = std::min(nearest_, length(to_double(r.ray.origin) - pupil_));
    // Stop in front of all glass: the minimal distance is half its width.
    nearest_ =
        std::max(0.98 * nearest_, 0.5e-3 * lens.first_order().entrance_pupil_diameter);
    std::vector<Record> records;
    records.reserve(rays.size() * layers_);
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (int k = 0; k < layers_; ++k) {
            const Vec3d o = to_double(rays[i].ray.origin) - pupil_,
                        d = to_double(rays[i].ray.direction);
            const double layer = k + hash_uniform(k, i), near = layer / layers_;
            const double distance = nearest_ / (near * near), along = dot(o, d);
            const double t =
                std::sqrt(distance * distance - length_squared(o) + along * along) -
                along;
            if (!(t > 0)) continue;  // inside the glass
            const Sight s = sight(o + d * t, 1);
            if (dot(d, s.e) < kSteepest) continue;
            const Vec3d q = o - d * (dot(o, s.e) / dot(d, s.e));
            records.push_back({s.angle, {dot(q, s.x), dot(q, s.y)}, s.layer});
        }
    return records;
}

void PupilShape::bound_angles(const std::vector<Record>& records) {
    for (const Record& r : records)
        for (const int k : {0, 1}) {
            Angles& a = angles_[std::min(int(r.layer), layers_ - 1) + k];
            a.low = {std::min(a.low.x, r.angle.x), std::min(a.low.y, r.angle.y)};
            a.high = {std::max(a.high.x, r.angle.x), std::max(a.high.y, r.angle.y)};
        }
    for (Angles& a : angles_) {
        const Vec2d margin = (a.high - a.low) * 0.01;
        a.low = axial_ ? Vec2d{} : a.low - margin;
        a.high = a.high + margin;
    }
}

/// Bounding ovals of the records nearest to each corner. If ovals move between corners, the first
/// round overestimates them, because records spread by that motion; later rounds measure records
/// relative to the ovals.
void PupilShape::fit_ovals(const std::vector<Record>& records) {
    std::fill(ovals_.begin(), ovals_.end(), Oval{{}, {1, 1}});
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Angles> reach(ovals_.size());
        std::vector<int> count(ovals_.size());
        for (const Record& r : records) {
            const auto at = placed(r);
            if (!at) continue;
            const auto corner = [](double x) { return std::size_t(x + 0.5); };
            const std::size_t i =
                (corner(at->place.z) * (rows_ + 1) + corner(at->place.y)) *
                    (columns_ + 1) +
                corner(at->place.x);
            const Vec2d p = at->in_oval;
            const double top = axial_ ? std::abs(p.y) : p.y, bottom = axial_ ? -top : p.y;
            reach[i].low = {std::min(reach[i].low.x, p.x),
                            std::min(reach[i].low.y, bottom)};
            reach[i].high = {std::max(reach[i].high.x, p.x),
                             std::max(reach[i].high.y, top)};
            ++count[i];
        }
        for (std::size_t i = 0; i < ovals_.size(); ++i) {
            if (count[i] < kFewest) continue;
            const Vec2d middle = (reach[i].low + reach[i].high) * 0.5,
                        half = (reach[i].high - reach[i].low) * 0.5;
            Oval& o = ovals_[i];
            o.center = o.center + Vec2d{o.half.x * middle.x, o.half.y * middle.y};
            o.half = {o.half.x * half.x, o.half.y * half.y};
        }
        fill_ovals(count);
    }
}

std::optional<PupilShape::Placed> PupilShape::placed(const Record& r) const {
    Sight s;
    s.angle = r.angle, s.layer = r.layer;
    const auto place = grid_place(s);
    if (!place) return std::nullopt;
    const Oval o = oval_at(*place);
    return Placed{*place,
                  {(r.at.x - o.center.x) / o.half.x, (r.at.y - o.center.y) / o.half.y}};
}

/// Corners with too few records take the mean of their neighbours.
void PupilShape::fill_ovals(std::vector<int>& count) {
    const int nx = columns_ + 1, ny = rows_ + 1, nz = layers_ + 1;
    const auto index = [&](int x, int y, int z) {
        return (std::size_t(z) * ny + y) * nx + x;
    };
    for (bool missing = true; missing;) {
        missing = false;
        const std::vector<int> known = count;
        bool any = false;
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) {
                    if (known[index(x, y, z)] >= kFewest) continue;
                    Oval sum;
                    int n = 0;
                    const auto add = [&](int i, int j, int k) {
                        if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz)
                            return;
                        if (known[index(i, j, k)] < kFewest) return;
                        const Oval& o = ovals_[index(i, j, k)];
                        sum.center = sum.center + o.center, sum.half = sum.half + o.half,
                        ++n;
                    };
                    add(x - 1, y, z), add(x + 1, y, z), add(x, y - 1, z),
                        add(x, y + 1, z);
                    add(x, y, z - 1), add(x, y, z + 1);
                    missing = true;
                    if (n == 0) continue;
                    ovals_[index(x, y, z)] = {sum.center * (1.0 / n),
                                              sum.half * (1.0 / n)};
                    count[index(x, y, z)] = kFewest;
                    any = true;
                }
        if (!any) break;
    }
}

/// Columns that cover a rim, slightly enlarged about its centre.
PupilShape::Cell PupilShape::covered(std::vector<Vec2f> top, std::vector<Vec2f> bottom,
                                     float margin) {
    float up = -1e30f, down = -1e30f;
    for (const Vec2f p : top) up = std::max(up, p.y);
    for (const Vec2f p : bottom) down = std::max(down, p.y);
    const Vec2f middle{0.5f * (top.front().x + top.back().x), 0.5f * (up - down)};
    const auto grow = [&](std::vector<Vec2f>& h, float y) {
        for (Vec2f& p : h)
            p = {middle.x + margin * (p.x - middle.x), y + margin * (p.y - y)};
    };
    grow(top, middle.y), grow(bottom, -middle.y);
    Cell c;
    c.first = top.front().x, c.last = top.back().x;
    float area = 0;
    for (int k = 0; k < kColumns; ++k) {
        const float a = c.first + k * c.width(),
                    b = k + 1 < kColumns ? a + c.width() : c.last;
        c.high[k] = highest(top, a, b), c.low[k] = -highest(bottom, a, b);
        area += (c.high[k] - c.low[k]) * c.width();
        c.until[k] = area;
    }
    return c;
}

/// Cells that a record contributes to. Cells overlap slightly, since extremes often occur at their
/// edges.
std::vector<PupilShape::Member> PupilShape::members(
    const std::vector<Record>& records) const {
    std::vector<Member> all;
    all.reserve(records.size() * 3 / 2);
    for (const Record& r : records) {
        const auto known = placed(r);
        if (!known) continue;
        std::array<std::size_t, 8> seen;
        int n = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const auto moved = [&](double g, int bit, int cells) {
                return std::clamp(g + (corner & bit ? kOverlap : -kOverlap), 0.0,
                                  double(cells));
            };
            const Vec3d at = known->place;
            const std::size_t cell =
                cell_at({moved(at.x, 1, columns_), moved(at.y, 2, rows_),
                         moved(at.z, 4, layers_)});
            if (std::find(seen.begin(), seen.begin() + n, cell) != seen.begin() + n)
                continue;
            seen[n++] = cell;
            all.push_back({cell, {float(known->in_oval.x), float(known->in_oval.y)}});
        }
    }
    return all;
}

/// For each cell, the cell itself and neighbours with few records.
std::vector<std::vector<std::size_t>> PupilShape::shared_with(
    const std::vector<Member>& members) const {
    std::vector<int> count(cells_.size());
    for (const Member& m : members) ++count[m.cell];
    std::vector<std::vector<std::size_t>> targets(cells_.size());
    const int ny = std::max(rows_, 1);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const int x = int(i % columns_), y = int(i / columns_ % ny),
                  z = int(i / columns_ / ny);
        for (int c = std::max(z - 1, 0); c <= std::min(z + 1, layers_ - 1); ++c)
            for (int b = std::max(y - 1, 0); b <= std::min(y + 1, ny - 1); ++b)
                for (int a = std::max(x - 1, 0); a <= std::min(x + 1, columns_ - 1);
                     ++a) {
                    const std::size_t other = (std::size_t(c) * ny + b) * columns_ + a;
                    if (other == i || count[other] < kFew) targets[i].push_back(other);
                }
    }
    return targets;
}

void PupilShape::fit_cells(const std::vector<Record>& records) {
    const std::vector<Member> all = members(records);
    const auto targets = shared_with(all);
    std::vector<Rim> rims(cells_.size());
    for (const Member& m : all)
        for (const std::size_t i : targets[m.cell]) rims[i].widen(m.at);
    for (const Member& m : all)
        for (const std::size_t i : targets[m.cell]) {
            rims[i].add(m.at);
            if (axial_) rims[i].add({m.at.x, -m.at.y});
        }
    const bool image = lens_.settings().iris.kind() == Iris::Kind::image;
    const float margin = image || !axial_ ? kWideMargin : kMargin;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        cells_[i].until.fill(0);
        const Rim& r = rims[i];
        if (!r.lit()) continue;
        const auto flipped = [](Vec2f p) { return Vec2f{p.x, -p.y}; };
        cells_[i] = covered(hull(r.left, r.top, r.right),
                            hull(flipped(r.left), r.bottom, flipped(r.right)), margin);
    }
}

}  // namespace dg
