#include "optics/aim/free_aim.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "math/quasi_random.h"
#include "optics/aim/pupil_visible.h"

namespace dg {
namespace {

constexpr int kNodes = kFilmCells + 1, kCells = kFilmCells * kFilmCells;
constexpr int kMinDegree = 4, kMaxDegree = 7;
constexpr double kOutlineMargin = 0.008;
constexpr int kCoverageRays = 32768;

class FreeAimMaker {
  public:
    FreeAimMaker(const Tracer& tracer, const AimRequest& request);
    Aim make();

  private:
    std::vector<FreeSlopeSample> training(int count, int first) const;
    bool fit(int degree);
    void choose_regions();
    void set_region(int cell, AimRegion region, const Columns& columns);
    void fall_back(const std::vector<bool>& bad);
    SlopeBox slope_box(int node) const;
    std::vector<bool> uncovered_cells() const;
    bool covers(int cell, Vec2d f, Vec2d m, Vec2d iris, double l) const;
    bool used(int cell) const;
    Vec2d node(int i) const {
        return {2.0 * (i % kNodes) / kFilmCells - 1, 2.0 * (i / kNodes) / kFilmCells - 1};
    }
    static int cell_of(Vec2d f);
    static std::array<int, 4> corners(int cell);

    const Tracer& tracer_;
    const AimRequest& request_;
    FilmPlane plane_;
    FilmRectangle film_;
    ChiefMap chief_;
    LensTables open_, real_;  // without the iris; with the iris
    double outer_;            // mm, radius of the enlarged iris
    std::vector<Columns> columns_;
    std::vector<bool> jacobian_ok_;
    Aim aim_;
};

FilmPlane film_plane(const AimRequest& r) {
    return r.tilted ? *r.tilted : FilmPlane{{0, 0, r.film_z}};
}

FilmRectangle film_rectangle(const AimRequest& r) {
    const Vec2d all{r.film_radius, r.film_radius};
    return r.film.half.x > 0 && r.film.half.y > 0 ? r.film : FilmRectangle{{}, all};
}

FreeAimMaker::FreeAimMaker(const Tracer& tracer, const AimRequest& request)
    : tracer_(tracer),
      request_(request),
      plane_(film_plane(request)),
      film_(film_rectangle(request)),
      chief_(tracer, plane_, film_),
      columns_(kCells),
      jacobian_ok_(kCells, true) {
    open_ = make_lens_tables(tracer, plane_, true, nullptr, 0);
    open_.semi2[tracer.stop()] = 3e38f;
    real_ = make_lens_tables(tracer, plane_, true, &request.iris, request.iris_radius);
    outer_ = outer_radius(request);
    AimTables& t = aim_.tables;
    t.film_radius = float(request.film_radius);
    set_iris_scale(t, request);
    FreeAimTables& f = t.free;
    f.center_x = float(film_.center.x), f.center_y = float(film_.center.y);
    f.half_x = float(film_.half.x), f.half_y = float(film_.half.y);
    const Vec3d normal = plane_.normal();
    for (int k = 0; k < 3; ++k) f.normal[k] = float(normal[k]);
    f.region.assign(kCells, 0), f.area.assign(kCells, 0);
    const std::size_t columns = kCells * (kColumns + 1);
    f.column_x.assign(columns, 0), f.column_low.assign(columns, 0);
    f.column_high.assign(columns, 0);
}

int FreeAimMaker::cell_of(Vec2d f) {
    const auto index = [](double u) {
        return std::clamp(int((u + 1) * kFilmCells / 2), 0, kFilmCells - 1);
    };
    return index(f.x) + kFilmCells * index(f.y);
}

std::array<int, 4> FreeAimMaker::corners(int cell) {
    const int first = cell / kFilmCells * kNodes + cell % kFilmCells;
    return {first, first + 1, first + kNodes, first + kNodes + 1};
}

/// Whether a cell overlaps the disc of the film radius.
bool FreeAimMaker::used(int cell) const {
    const std::array<int, 4> at = corners(cell);
    const Vec2d a = film_.at(node(at[0])), b = film_.at(node(at[3]));
    const double x = std::clamp(0.0, a.x, b.x), y = std::clamp(0.0, a.y, b.y);
    return hypot(x, y) <= request_.film_radius;
}

/// Rays from all over the film through a slightly enlarged iris, traced to the stop.
std::vector<FreeSlopeSample> FreeAimMaker::training(int count, int first) const {
    std::vector<FreeSlopeSample> samples;
    for (int n = first; int(samples.size()) < count && n < first + 12 * count; ++n) {
        const auto q = quasi_random<5>(n);
        const Vec2d f{2 * q[0] - 1, 2 * q[1] - 1};
        if (!used(cell_of(f))) continue;
        const double nm = 380 + 400 * q[4];
        const Vec2d m = chief_.slope(f, 1.15 * outer_ * concentric_disc({q[2], q[3]}));
        const auto iris = tracer_.to_iris(
            {plane_.at(film_.at(f)), normalize(Vec3d{-m.x, -m.y, -1})}, tracer_.at(nm), kWidened);
        if (!iris) continue;
        const Vec2d a = *iris * (1 / aim_.tables.iris_scale);
        if (dot(a, a) <= 1) samples.push_back({f, a, real_.scale(nm), m});
    }
    return samples;
}

/// Returns false, without a fit, if too few rays reach the iris.
bool FreeAimMaker::fit(int degree) {
    const int terms = free_term_count(degree);
    FreeAimTables& t = aim_.tables.free;
    t.degree = degree;
    const std::vector<FreeSlopeSample> samples = training(std::max(800, 4 * terms), 0);
    if (int(samples.size()) < 2 * terms) {
        aim_.free_slopes = {degree, std::vector<double>(2 * terms)};
        t.coefficients.assign(2 * terms, 0.f);
        return false;
    }
    aim_.free_slopes = fit_free_slopes(samples, degree);
    t.coefficients.assign(aim_.free_slopes.coefficients.begin(),
                          aim_.free_slopes.coefficients.end());
    aim_.fit_error = aim_.iris_error = 0;
    for (const FreeSlopeSample& s : training(500, 100000)) {
        const SlopeValue v = aim_.free_slopes.evaluate(s.f, s.a, s.l);
        aim_.fit_error = std::max(aim_.fit_error, length(v.m - s.m));
        aim_.iris_error = std::max(aim_.iris_error, length(v.step(v.m - s.m)));
    }
    set_enlargement(aim_.tables, request_, aim_.iris_error);
    return true;
}

void FreeAimMaker::set_region(int cell, AimRegion region, const Columns& columns) {
    FreeAimTables& t = aim_.tables.free;
    columns_[cell] = columns;
    t.region[cell] = float(int(region));
    t.area[cell] = region == AimRegion::shape ? aim_.tables.shape_area : float(columns.area);
    for (int k = 0; k <= kColumns; ++k) {
        const int at = cell * (kColumns + 1) + k;
        t.column_x[at] = float(columns.x[k]);
        t.column_low[at] = k < kColumns ? float(columns.low[k]) : 0;
        t.column_high[at] = k < kColumns ? float(columns.high[k]) : 0;
    }
}

void FreeAimMaker::choose_regions() {
    const AimTables& t = aim_.tables;
    const double reach = outer_ / t.iris_scale * t.enlargement / kEnlargement;
    const double orientation = aim_.free_slopes.evaluate({}, {}, 0).jacobian;
    std::vector<std::optional<Visible>> seen(kNodes * kNodes);
    for (int cell = 0; cell < kCells; ++cell) {
        if (!used(cell)) {
            set_region(cell, AimRegion::visible, {});
            continue;
        }
        Outline all = Outline::dark(reach, 49);
        bool ok = true;
        for (const int i : corners(cell)) {
            if (!seen[i])
                seen[i] = visible_iris(open_, t, film_.at(node(i)), reach, orientation);
            all = all.joined(seen[i]->outline);
            ok = ok && seen[i]->jacobian_ok;
        }
        jacobian_ok_[cell] = ok;
        const Columns columns = cover(all.grown(kOutlineMargin * reach));
        const bool smaller = columns.area < 0.97 * t.shape_area;
        set_region(cell, smaller ? AimRegion::visible : AimRegion::shape, columns);
    }
}

/// Whether the aim's sampling domain contains a passing ray.
bool FreeAimMaker::covers(int cell, Vec2d f, Vec2d m, Vec2d iris, double l) const {
    const AimTables& t = aim_.tables;
    Vec2d a = iris * (1 / t.iris_scale);
    for (int step = 0; step < 3; ++step) {  // Newton's method for the iris point of the aim's polynomial
        const SlopeValue v = aim_.free_slopes.evaluate(f, a, l);
        a = a + v.step(m - v.m);
    }
    if (!(length(aim_.free_slopes.evaluate(f, a, l).m - m) < 1e-6)) return false;
    if (t.free.region[cell] > 0.5f) return columns_[cell].contain(a.x, a.y);
    return request_.iris.in_sampling_region(a * (t.iris_scale / request_.iris_radius),
                                            t.enlargement);
}

/// Cells with an unsampled passing ray among fresh random rays, or with a sign change of the
/// Jacobian.
std::vector<bool> FreeAimMaker::uncovered_cells() const {
    std::vector<bool> bad(kCells);
    for (int i = 0; i < kCells; ++i) bad[i] = used(i) && !jacobian_ok_[i];
    const auto film = std::make_unique<FilmRays>();
    const auto out = std::make_unique<SceneRays>();
    std::array<Vec2d, kLensBatch> at;
    for (int n = 0; n < kCoverageRays; n += kLensBatch) {
        for (int i = 0; i < kLensBatch; ++i) {
            const auto q = quasi_random<5>(200000 + n + i);
            at[i] = {2 * q[0] - 1, 2 * q[1] - 1};
            // Half of the rays are near the rim of the iris, where coverage fails first.
            Vec2d target = concentric_disc({q[2], q[3]});
            if (i % 2) target = target * (1 / std::max(1e-9, length(target)));
            target = target * (outer_ * (i % 2 ? 0.97 + 0.04 * q[3] : 1.1));
            const Vec2d m = chief_.slope(at[i], target), mm = film_.at(at[i]);
            film->x[i] = float(mm.x), film->y[i] = float(mm.y);
            film->mx[i] = float(m.x), film->my[i] = float(m.y);
            film->nm[i] = float(380 + 400 * q[4]);
        }
        trace_to_scene(real_, *film, *out, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            const int cell = cell_of(at[i]);
            if (!(out->pass[i] > 0) || !used(cell) || bad[cell]) continue;
            bad[cell] = !covers(cell, at[i], {film->mx[i], film->my[i]},
                                {out->iris_x[i], out->iris_y[i]}, real_.scale(film->nm[i]));
        }
    }
    return bad;
}

/// Bounding box of the passing slopes at a node.
SlopeBox FreeAimMaker::slope_box(int i) const {
    const auto range = [&](double reach) {
        SlopeBox box;
        for (int k = 0; k < 16; ++k) {
            const double angle = kPiD * k / 8;
            const Vec2d m =
                chief_.slope(node(i), reach * outer_ * Vec2d{std::cos(angle), std::sin(angle)});
            box.add({m.x, m.x, m.y, m.y});
        }
        return box;
    };
    return passing_box(open_, film_.at(node(i)), outer_, range);
}

void FreeAimMaker::fall_back(const std::vector<bool>& bad) {
    std::vector<std::optional<SlopeBox>> node_box(kNodes * kNodes);
    for (int cell = 0; cell < kCells; ++cell) {
        if (!bad[cell] || !used(cell)) continue;
        SlopeBox box;
        for (const int i : corners(cell)) {
            if (!node_box[i]) node_box[i] = slope_box(i);
            box.add(*node_box[i]);
        }
        box.grow(0.01 * (box.x1 - box.x0), 0.01 * (box.y1 - box.y0));
        set_region(cell, AimRegion::slopes,
                   box.empty() ? Columns{} : rectangle(box.x0, box.x1, box.y0, box.y1));
        ++aim_.fallback_segments;
    }
}

Aim FreeAimMaker::make() {
    std::vector<bool> bad(kCells, true);
    std::optional<Aim> best;
    const auto count = [](const std::vector<bool>& b) { return std::count(b.begin(), b.end(), true); };
    if (request_.draw != PupilDraw::aimed) {
        fit(kMinDegree);
    } else {
        for (int degree = kMinDegree; degree <= kMaxDegree; ++degree) {
            if (!fit(degree)) break;
            choose_regions();
            const std::vector<bool> now = uncovered_cells();
            if (degree > kMinDegree && count(now) >= count(bad)) continue;
            bad = now, best = aim_;
            if (count(bad) == 0) return aim_;
        }
        if (best) aim_ = *best;
    }
    fall_back(bad);
    return aim_;
}

}  // namespace

Aim make_free_aim(const Tracer& tracer, const AimRequest& request) {
    return FreeAimMaker(tracer, request).make();
}

}  // namespace dg
