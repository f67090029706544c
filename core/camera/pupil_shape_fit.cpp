// pupil_shape_fit.cpp -- the set-up of PupilShape: camera rays tell where the light of points along them passes.
#include <algorithm>
#include <cmath>
#include <span>

#include "camera/pupil_shape.h"
#include "math/hash.h"
#include "optics/quasi_random.h"

namespace dg {
namespace {

// What rays between those that were drawn may reach; of an image no rim is known.
constexpr float kMargin = 1.03f, kImageMargin = 1.06f;
constexpr double kFilmEdge = 1.03;   // film points beyond the edge are moved onto it
constexpr int kFew = 300;            // records below which a cell takes its neighbours' as well
constexpr int kFewest = 24;          // below which a corner has no oval of its own
constexpr double kOverlap = 0.2;     // of cells, in cells
constexpr int kHalvings = 6;

/// Of the rays that the camera draws those at the rim of what passes, and some within.
class Probe {
  public:
    Probe(const ExactLens& lens, bool axial) : lens_(lens), axial_(axial) {}

    /// Along lines from the middle of the lens samples to their edge, the farthest that is found to pass.
    std::vector<CameraRay> rim(int count) const {
        std::vector<CameraSample> samples(count);
        std::vector<CameraRay> rays(count), best(count);
        std::vector<double> inner(count, 0), step(count, 1);
        for (int k = 0; k <= kHalvings; ++k) {
            for (int i = 0; i < count; ++i) samples[i] = sample(i, std::min(inner[i] + step[i], 1.0));
            lens_.generate(samples, rays);
            for (int i = 0; i < count; ++i) {
                const bool passed = rays[i].weight > 0;
                if (passed) best[i] = rays[i], inner[i] = std::min(inner[i] + step[i], 1.0);
                step[i] *= 0.5;
            }
        }
        return best;
    }
    std::vector<CameraRay> within(int count) const {
        std::vector<CameraSample> samples(count);
        std::vector<CameraRay> rays(count);
        for (int i = 0; i < count; ++i) samples[i] = sample(i, std::sqrt(hash_uniform(9, i)));
        lens_.generate(samples, rays);
        return rays;
    }

  private:
    /// `out`: 0 in the middle of the lens samples, 1 at their edge.
    CameraSample sample(int i, double out) const {
        const auto u = quasi_random<4>(i);
        const double side = 4 * u[2], along = 2 * (side - std::floor(side)) - 1;
        const Vec2d edge[] = {{1, along}, {-1, along}, {along, 1}, {along, -1}};
        const Vec2d lens = edge[std::min(int(side), 3)] * out;
        return {film_point(u[0], u[1]),
                {float(0.5 + 0.499999 * lens.x), float(0.5 + 0.499999 * lens.y)},
                0,
                float(380 + 400 * u[3])};
    }
    Vec2f film_point(double u, double v) const {
        const ExactLensSettings& s = lens_.settings();
        const double radius = 1.02 * s.half_diagonal_mm;
        if (axial_) {
            const double r = radius * std::min(kFilmEdge * u, 0.999999), a = 2 * kPiD * v;
            return {float(r * std::cos(a)), float(r * std::sin(a))};
        }
        const auto across = [](double x) { return std::clamp(kFilmEdge * (2 * x - 1), -1.0, 1.0); };
        const bool whole = !(s.film_half_mm.x > 0 && s.film_half_mm.y > 0);
        const Vec2d half = whole ? Vec2d{radius, radius} : s.film_half_mm * 1.02;
        const Vec2d film = (whole ? Vec2d{} : s.film_center_mm) + Vec2d{half.x * across(u), half.y * across(v)};
        return {float(film.x), float(film.y)};
    }

    const ExactLens& lens_;
    bool axial_;
};

/// An image is drawn pixel by pixel, in no order: it has no rim to look for.
std::vector<CameraRay> passing(const ExactLens& lens, bool axial) {
    const Probe probe(lens, axial);
    const Iris::Kind iris = lens.settings().iris.kind();
    const bool image = iris == Iris::Kind::image;
    const int count = (axial ? 6000 : 24000) * (iris == Iris::Kind::blades ? 2 : 1);
    std::vector<CameraRay> rays = probe.within(image ? 7 * count : 2 * count / 3);
    if (!image) {
        const std::vector<CameraRay> rim = probe.rim(count);
        rays.insert(rays.end(), rim.begin(), rim.end());
    }
    std::erase_if(rays, [](const CameraRay& r) { return !(r.weight > 0); });
    return rays;
}

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

/// One point on every ray in every layer of nearness.
std::vector<PupilShape::Record> PupilShape::look_back(const ExactLens& lens) {
    const std::vector<CameraRay> rays = passing(lens, axial_);
    nearest_ = 1e9;
    for (const CameraRay& r : rays)
        nearest_ = std::min(nearest_, length(to_double(r.ray.origin) - pupil_));
    // A stop before all glass: no nearer than it is wide.
    nearest_ = std::max(0.98 * nearest_, 0.5e-3 * lens.first_order().entrance_pupil_diameter);
    std::vector<Record> records;
    records.reserve(rays.size() * layers_);
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (int k = 0; k < layers_; ++k) {
            const Vec3d o = to_double(rays[i].ray.origin) - pupil_, d = to_double(rays[i].ray.direction);
            const double layer = k + hash_uniform(k, i), near = layer / layers_;
            const double distance = nearest_ / (near * near), along = dot(o, d);
            const double t = std::sqrt(distance * distance - length_squared(o) + along * along) - along;
            if (!(t > 0)) continue;   // in the glass
            const Sight s = sight(o + d * t, 1);
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

/// Around the records nearest to each corner of the cells.
void PupilShape::fit_ovals(const std::vector<Record>& records) {
    std::vector<Angles> reach(ovals_.size());
    std::vector<int> count(ovals_.size());
    for (const Record& r : records) {
        Sight s;
        s.angle = r.angle, s.layer = r.layer;
        const auto place = grid_place(s);
        if (!place) continue;
        const auto corner = [](double x) { return std::size_t(x + 0.5); };
        const std::size_t i =
            (corner(place->z) * (rows_ + 1) + corner(place->y)) * (columns_ + 1) + corner(place->x);
        Angles& a = reach[i];
        const double y = axial_ ? std::abs(r.at.y) : r.at.y;
        a.low = {std::min(a.low.x, r.at.x), axial_ ? std::min(a.low.y, -y) : std::min(a.low.y, y)};
        a.high = {std::max(a.high.x, r.at.x), std::max(a.high.y, y)};
        ++count[i];
    }
    for (std::size_t i = 0; i < ovals_.size(); ++i)
        if (count[i] >= kFewest)
            ovals_[i] = {(reach[i].low + reach[i].high) * 0.5, (reach[i].high - reach[i].low) * 0.5};
    fill_ovals(count);
}

/// Corners of which no ray tells take the mean of their neighbours.
void PupilShape::fill_ovals(std::vector<int>& count) {
    const int nx = columns_ + 1, ny = rows_ + 1, nz = layers_ + 1;
    const auto index = [&](int x, int y, int z) { return (std::size_t(z) * ny + y) * nx + x; };
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
                        if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return;
                        if (known[index(i, j, k)] < kFewest) return;
                        const Oval& o = ovals_[index(i, j, k)];
                        sum.center = sum.center + o.center, sum.half = sum.half + o.half, ++n;
                    };
                    add(x - 1, y, z), add(x + 1, y, z), add(x, y - 1, z), add(x, y + 1, z);
                    add(x, y, z - 1), add(x, y, z + 1);
                    missing = true;
                    if (n == 0) continue;
                    ovals_[index(x, y, z)] = {sum.center * (1.0 / n), sum.half * (1.0 / n)};
                    count[index(x, y, z)] = kFewest;
                    any = true;
                }
        if (!any) break;
    }
}

namespace {

/// What is known of a cell's rim: the highest and lowest record in fine columns, and the outermost ones.
struct Rim {
    static constexpr int kFine = 96;
    Vec2f left{1e30f, 0}, right{-1e30f, 0};
    std::array<Vec2f, kFine> top, bottom;   // bottom: upside down, too

    Rim() { top.fill({0, -1e30f}), bottom.fill({0, -1e30f}); }
    bool lit() const { return left.x < right.x; }
    void widen(Vec2f p) {
        if (p.x < left.x) left = p;
        if (p.x > right.x) right = p;
    }
    void add(Vec2f p) {
        const int k = std::min(int((p.x - left.x) / (right.x - left.x) * kFine), kFine - 1);
        if (p.y > top[k].y) top[k] = p;
        if (-p.y > bottom[k].y) bottom[k] = {p.x, -p.y};
    }
};

/// The upper half of the convex hull, from left to right: what mounts and blades leave has few dents.
std::vector<Vec2f> hull(Vec2f left, std::span<const Vec2f> points, Vec2f right) {
    std::vector<Vec2f> h;
    const auto add = [&](Vec2f p) {
        while (h.size() > 1) {
            const Vec2f a = h[h.size() - 2], b = h.back();
            if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0) break;
            h.pop_back();
        }
        h.push_back(p);
    };
    add(left);
    for (const Vec2f p : points)
        if (p.y > -1e29f && p.x > left.x && p.x < right.x) add(p);
    add(right);
    return h;
}

/// The highest point of a hull over [a, b].
float highest(const std::vector<Vec2f>& h, float a, float b) {
    float high = -1e30f;
    for (std::size_t i = 0; i < h.size(); ++i) {
        if (h[i].x >= a && h[i].x <= b) high = std::max(high, h[i].y);
        if (i == 0) continue;
        const Vec2f p = h[i - 1], q = h[i];
        for (const float x : {a, b})
            if (p.x <= x && x <= q.x && p.x < q.x)
                high = std::max(high, p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x));
    }
    return high;
}

}  // namespace

/// Columns around a rim that is grown a little about its middle.
PupilShape::Cell PupilShape::covered(std::vector<Vec2f> top, std::vector<Vec2f> bottom, float margin) {
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
        const float a = c.first + k * c.width(), b = k + 1 < kColumns ? a + c.width() : c.last;
        c.high[k] = highest(top, a, b), c.low[k] = -highest(bottom, a, b);
        area += (c.high[k] - c.low[k]) * c.width();
        c.until[k] = area;
    }
    return c;
}

void PupilShape::fit_cells(const std::vector<Record>& records) {
    struct Placed {
        std::size_t cell;
        Vec2f at;   // in its oval
    };
    std::vector<Placed> placed;
    placed.reserve(records.size());
    std::vector<int> count(cells_.size());
    for (const Record& r : records) {
        Sight s;
        s.angle = r.angle, s.layer = r.layer;
        const auto place = grid_place(s);
        if (!place) continue;
        const Oval o = oval_at(*place);
        const Vec2d at{(r.at.x - o.center.x) / o.half.x, (r.at.y - o.center.y) / o.half.y};
        // Cells go a little beyond their edges, where what they hold often reaches farthest.
        const auto clamped = [](double g, int cells) { return std::clamp(g, 0.0, double(cells)); };
        std::array<std::size_t, 8> seen;
        int n = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const auto moved = [&](double g, int bit) { return g + (corner & bit ? kOverlap : -kOverlap); };
            const std::size_t cell = cell_at({clamped(moved(place->x, 1), columns_),
                                              clamped(moved(place->y, 2), rows_),
                                              clamped(moved(place->z, 4), layers_)});
            if (std::find(seen.begin(), seen.begin() + n, cell) != seen.begin() + n) continue;
            seen[n++] = cell;
            placed.push_back({cell, {float(at.x), float(at.y)}});
            ++count[cell];
        }
    }
    // Where else records count: neighbours that have few of their own.
    std::vector<std::vector<std::size_t>> targets(cells_.size());
    const int ny = std::max(rows_, 1);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const int x = int(i % columns_), y = int(i / columns_ % ny), z = int(i / columns_ / ny);
        for (int c = std::max(z - 1, 0); c <= std::min(z + 1, layers_ - 1); ++c)
            for (int b = std::max(y - 1, 0); b <= std::min(y + 1, ny - 1); ++b)
                for (int a = std::max(x - 1, 0); a <= std::min(x + 1, columns_ - 1); ++a) {
                    const std::size_t other = (std::size_t(c) * ny + b) * columns_ + a;
                    if (other == i || count[other] < kFew) targets[i].push_back(other);
                }
    }
    const bool image = lens_.settings().iris.kind() == Iris::Kind::image;
    const float margin = image ? kImageMargin : kMargin;
    std::vector<Rim> rims(cells_.size());
    for (const Placed& p : placed)
        for (const std::size_t i : targets[p.cell]) rims[i].widen(p.at);
    for (const Placed& p : placed)
        for (const std::size_t i : targets[p.cell]) {
            rims[i].add(p.at);
            if (axial_) rims[i].add({p.at.x, -p.at.y});
        }
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
