#include "optics/pupil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "optics/free_aim.h"
#include "optics/lens_error.h"
#include "optics/pupil_region.h"
#include "optics/quasi_random.h"
#include "optics/pupil_region.h"
#include "optics/quasi_random.h"

namespace dg {
namespace {

constexpr int kNodes = kRadialSegments + 1;
constexpr int kMinDegree = 3, kMaxDegree = 6;
constexpr std::array<double, 3> kBoundWavelengths{380, 550, 780};  // nm
constexpr double kShapeMargin =
    1.02;  // the fit reaches this far beyond the enlarged iris
// Training rays may leave the clear diameters a little, so that the fit is not cut off at
// the edge of what passes; far outside, rays can reach the iris a second time (a fold),
// which no one-to-one map follows.
constexpr double kWidened = 1.2;
constexpr int kCoverageRays = 16384;
// What is drawn reaches so far beyond what was seen from the two ends of a segment, in iris radii.
constexpr double kOutlineMargin = 0.005;

/// First order on the film's side of the stop: iris = by_film f + by_slope m.
struct RearHalf {
    double by_film, by_slope;
    double slope_for(double iris, double film) const {
        return (iris - by_film * film) / by_slope;
    }
};

class AimMaker {
  public:
    AimMaker(const Tracer& tracer, const AimRequest& request);
    Aim make();

  private:
    struct Box {
        double x0 = 1e30, x1 = -1e30, half = -1;
        bool empty() const { return half < 0; }
        void add(double x, double y) {
            x0 = std::min(x0, x), x1 = std::max(x1, x),
            half = std::max(half, std::abs(y));
        }
        void add(const Box& b) {
            x0 = std::min(x0, b.x0), x1 = std::max(x1, b.x1),
            half = std::max(half, b.half);
        }
        void grow(double x, double y) {
            if (empty()) return;
            x0 -= x, x1 += x, half += y;
        }
    };
    struct Visible {
        Outline outline;
        bool jacobian_ok = true;
    };

    std::optional<Vec2d> trace_iris(double r, Vec2d m, double nm) const;
    std::vector<SlopeSample> training(int count, int first) const;
    double lit_radius() const;
    std::vector<bool> visible(double r, const std::vector<Vec2d>& points,
                              bool& jacobian_ok) const;
    Visible visible_iris(double r) const;
    Box slope_box(double r) const;
    Box slope_range(double r, double reach, double nm) const;
    Box passing_slopes(double r, const Box& range, int nx, int ny) const;
    bool fit(int k);
    void choose_regions();
    void set_region(int segment, AimRegion region, const Columns& columns);
    std::vector<bool> uncovered_segments() const;
    bool covers(int segment, double r, Vec2d m, Vec2d iris, double l,
                double azimuth) const;
    double unit(double iris_mm) const { return iris_mm / aim_.tables.iris_scale; }

    const Tracer& tracer_;
    const AimRequest& request_;
    LensTables open_;  // without the iris: what the mounts let through
    LensTables real_;
    RearHalf rear_;
    double outer_;  // mm, radius around the enlarged iris
    std::array<bool, kRadialSegments> jacobian_ok_;
    std::array<Columns, kRadialSegments> columns_;
    Aim aim_;
};

AimMaker::AimMaker(const Tracer& tracer, const AimRequest& request)
    : tracer_(tracer), request_(request) {
    open_ = make_lens_tables(tracer, request.film_z, true, nullptr, 0);
    open_.semi2[tracer.stop()] = 3e38f;
    real_ = make_lens_tables(tracer, request.film_z, true, &request.iris,
                             request.iris_radius);
    outer_ = kEnlargement * request.iris_radius * request.iris.outer_radius();
    AimTables& t = aim_.tables;
    t.film_radius = float(request.film_radius);
    t.iris_scale = float(kShapeMargin * outer_);
    t.enlargement = float(kEnlargement);
    const double scale = request.iris_radius / t.iris_scale;
    t.shape_area = float(request.iris.sampling_area(kEnlargement) * scale * scale);
    const double h = 1e-4, nm = kDesignWavelength;
    const auto film =
        tracer.to_iris({{h, 0, request.film_z}, {0, 0, -1}}, tracer.at(nm), 1);
    const auto slope = tracer.to_iris(
        {{0, 0, request.film_z}, normalize(Vec3d{-h, 0, -1})}, tracer.at(nm), 1);
    if (!film || !slope || slope->x == 0)
        throw LensError(tracer.prescription().name +
                            ": no ray leads from the film's centre to the iris",
                        "lens-no-light");
    rear_ = {film->x / h, slope->x / h};
}

std::optional<Vec2d> AimMaker::trace_iris(double r, Vec2d m, double nm) const {
    return tracer_.to_iris({{r, 0, request_.film_z}, normalize(Vec3d{-m.x, -m.y, -1})},
                           tracer_.at(nm), kWidened);
}

/// Rays over the film and somewhat more than the iris, traced to the stop.
std::vector<SlopeSample> AimMaker::training(int count, int first) const {
    std::vector<SlopeSample> samples;
    const AimTables& t = aim_.tables;
    for (int n = first; int(samples.size()) < count && n < first + 8 * count; ++n) {
        const auto q = quasi_random<4>(n);
        const double r = std::sqrt(q[0]) * t.film_radius, nm = 380 + 400 * q[3];
        const Vec2d target = 1.3 * outer_ * concentric_disc({q[1], q[2]});
        const Vec2d m{rear_.slope_for(target.x, r), rear_.slope_for(target.y, 0)};
        const auto iris = trace_iris(r, m, nm);
        if (!iris) continue;
        const Vec2d a{unit(iris->x), unit(iris->y)};
        if (dot(a, a) <= 1) samples.push_back({r / t.film_radius, a, real_.scale(nm), m});
    }
    return samples;
}

/// The farthest film point (mm) from which a ray reaches the iris, among many.
double AimMaker::lit_radius() const {
    double lit = 0;
    for (int n = 0; n < kCoverageRays; ++n) {
        const auto q = quasi_random<4>(n);
        const double r = q[0] * request_.film_radius;
        const Vec2d target = 1.3 * outer_ * concentric_disc({q[1], q[2]});
        const Vec2d m{rear_.slope_for(target.x, r), rear_.slope_for(target.y, 0)};
        if (r > lit && trace_iris(r, m, 380 + 400 * q[3])) lit = r;
    }
    return lit;
}

/// False, with nothing fitted, if too few rays reach the iris.
bool AimMaker::fit(int k) {
    const int count = std::max(600, 5 * term_count(k));
    AimTables& t = aim_.tables;
    std::vector<SlopeSample> samples = training(count, 0);
    if (int(samples.size()) < count / 2) {
        // A film far wider than the image circle: what lies in the dark needs no aim, and
        // film points beyond the tables' radius get no ray.
        const double lit = 1.1 * lit_radius();
        if (lit > 0 && lit < t.film_radius) {
            t.film_radius = float(lit);
            samples = training(count, 0);
        }
    }
    t.degree = k;
    if (int(samples.size()) < 2 * term_count(k)) {
        aim_.slopes = {k, std::vector<double>(2 * term_count(k))};
        t.coefficients.assign(aim_.slopes.coefficients.size(), 0.f);
        return false;
    }
    aim_.slopes = fit_slopes(samples, k);
    t.coefficients.assign(aim_.slopes.coefficients.begin(),
                          aim_.slopes.coefficients.end());
    aim_.fit_error = 0;
    for (const SlopeSample& s : training(500, 100000)) {
        const Vec2d m = aim_.slopes.evaluate(s.r, s.a, s.l).m;
        aim_.fit_error = std::max(aim_.fit_error, length(m - s.m));
    }
    return true;
}

/// Which of these points of the iris (unit, y >= 0 by symmetry) the mounts leave visible from a film
/// radius, at any of the bounding wavelengths.
std::vector<bool> AimMaker::visible(double r, const std::vector<Vec2d>& points,
                                    bool& jacobian_ok) const {
    std::vector<bool> seen(points.size());
    const AimTables& t = aim_.tables;
    const double axis_sign = aim_.slopes.evaluate(0, {0, 0}, 0).jacobian;
    auto in = std::make_unique<LensSamples>();
    auto film = std::make_unique<FilmRays>();
    auto out = std::make_unique<SceneRays>();
    alignas(64) float jacobian[kLensBatch];
    const std::size_t rays = points.size() * kBoundWavelengths.size();
    for (std::size_t begin = 0; begin < rays; begin += kLensBatch) {
        const auto ray = [&](int i) { return std::min(begin + i, rays - 1); };
        for (int i = 0; i < kLensBatch; ++i) {
            const Vec2d a = points[ray(i) % points.size()] * t.iris_scale;
            in->x[i] = float(r), in->y[i] = 0, in->u[i] = float(a.x), in->v[i] = float(a.y);
            in->nm[i] = float(kBoundWavelengths[ray(i) / points.size()]);
        }
        aim_slopes(open_, t, *in, *film, jacobian, kLensBatch);
        trace_to_scene(open_, *film, *out, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            if (!(jacobian[i] * axis_sign > 0)) jacobian_ok = false;
            if (out->pass[i] > 0) seen[ray(i) % points.size()] = true;
        }
    }
    return seen;
}

/// Up to where the columns of the iris are visible from one film radius: a coarse search upward from the
/// meridian, then a fine one in the step where visibility ends.
AimMaker::Visible AimMaker::visible_iris(double r) const {
    constexpr int kRows = 12, kFine = 8, kPoints = 97;
    Visible v{Outline::dark(unit(outer_), kPoints), true};
    std::array<double, kPoints> half{};
    std::array<double, kPoints> low{}, step{};
    for (int i = 0; i < kPoints; ++i) {
        const double x = v.outline.x(i);
        step[i] = std::sqrt(std::max(0.0, v.outline.reach * v.outline.reach - x * x)) / kRows;
    }
    const auto search = [&](int rows) {
        std::vector<Vec2d> points;
        for (int i = 0; i < kPoints; ++i)
            for (int row = 0; row <= rows; ++row)
                points.push_back({v.outline.x(i), low[i] + row * step[i]});
        const std::vector<bool> seen = visible(r, points, v.jacobian_ok);
        for (int i = 0; i < kPoints; ++i) {
            int last = rows;
            while (last >= 0 && !seen[i * (rows + 1) + last]) --last;
            // Up to the first row that is not seen: conservative.
            if (last >= 0) half[i] = low[i] + std::min(last + 1, rows) * step[i];
            low[i] += std::max(last, 0) * step[i];
        }
    };
    search(kRows);
    for (int i = 0; i < kPoints; ++i) {
        step[i] = (half[i] - low[i]) / kFine;
    }
    const std::array<double, kPoints> coarse = half;
    search(kFine);
    for (int i = 0; i < kPoints; ++i)
        if (coarse[i] > 0) v.outline.low[i] = -half[i], v.outline.high[i] = half[i];
    return v;
}

AimMaker::Box AimMaker::passing_slopes(double r, const Box& range, int nx, int ny) const {
    Box box;
    auto film = std::make_unique<FilmRays>();
    auto out = std::make_unique<SceneRays>();
    const double dx = (range.x1 - range.x0) / nx, dy = range.half / ny;
    int count = 0;
    const auto flush = [&] {
        for (int i = count; i < kLensBatch; ++i) {
            film->x[i] = film->x[0], film->y[i] = 0, film->nm[i] = film->nm[0];
            film->mx[i] = film->mx[0], film->my[i] = film->my[0];
        }
        trace_to_scene(open_, *film, *out, kLensBatch);
        for (int i = 0; i < count; ++i) {
            const double iris2 = double(out->iris_x[i]) * out->iris_x[i] +
                                 double(out->iris_y[i]) * out->iris_y[i];
            if (out->pass[i] > 0 && iris2 <= outer_ * outer_)
                box.add(film->mx[i], film->my[i]);
        }
        count = 0;
    };
    for (const double nm : kBoundWavelengths)
        for (int iy = 0; iy <= ny; ++iy)
            for (int ix = 0; ix <= nx; ++ix) {
                film->x[count] = float(r), film->y[count] = 0,
                film->nm[count] = float(nm);
                film->mx[count] = float(range.x0 + ix * dx),
                film->my[count] = float(iy * dy);
                if (++count == kLensBatch) flush();
            }
    if (count) flush();
    box.grow(dx, dy);
    return box;
}

AimMaker::Box AimMaker::slope_range(double r, double reach, double) const {
    const double middle = rear_.slope_for(0, r),
                 half = std::abs(reach * outer_ / rear_.by_slope);
    return {middle - half, middle + half, half};
}

/// Box around the slopes that pass at one film radius: the search widens until the box
/// lies inside.
AimMaker::Box AimMaker::slope_box(double r) const {
    for (double reach = 1.5; reach < 100; reach *= 1.6) {
        const Box range = slope_range(r, reach, 550);
        Box box = passing_slopes(r, range, 48, 24);
        if (box.empty()) box = passing_slopes(r, range, 160, 80);
        const bool inside = !box.empty() && box.x0 > range.x0 && box.x1 < range.x1 &&
                            box.half < range.half;
        if (!inside) continue;
        const Box fine = passing_slopes(r, box, 48, 24);
        return fine.empty() ? box : fine;
    }
    return {};
}

void AimMaker::set_region(int segment, AimRegion region, const Columns& columns) {
    AimTables& t = aim_.tables;
    columns_[segment] = columns;
    t.region[segment] = float(int(region));
    t.area[segment] = region == AimRegion::shape ? t.shape_area : float(columns.area);
    for (int k = 0; k <= kColumns; ++k) {
        const int at = segment * (kColumns + 1) + k;
        t.column_x[at] = float(columns.x[k]);
        t.column_half[at] = k < kColumns ? float(columns.high[k]) : 0;
    }
    if (region != AimRegion::shape) t.all_shape = false;
}

void AimMaker::choose_regions() {
    AimTables& t = aim_.tables;
    t.all_shape = true;
    std::vector<Visible> at(kNodes);
    for (int i = 0; i < kNodes; ++i)
        at[i] = visible_iris(t.film_radius * i / kRadialSegments);
    for (int i = 0; i < kRadialSegments; ++i) {
        jacobian_ok_[i] = at[i].jacobian_ok && at[i + 1].jacobian_ok;
        const Columns seen =
            cover(at[i].outline.joined(at[i + 1].outline, kOutlineMargin * unit(outer_)));
        const bool smaller = seen.area < 0.97 * t.shape_area;
        set_region(i, smaller ? AimRegion::visible : AimRegion::shape, seen);
    }
}

/// Whether the aim would draw this passing ray. `azimuth` turns the meridian against the
/// iris shape.
bool AimMaker::covers(int segment, double r, Vec2d m, Vec2d iris, double l,
                      double azimuth) const {
    const AimTables& t = aim_.tables;
    const double rn = r / t.film_radius;
    Vec2d a{unit(iris.x), unit(iris.y)};
    for (int step = 0; step < 3; ++step) {  // Newton: the aim's own iris point
        const SlopeValue v = aim_.slopes.evaluate(rn, a, l);
        const Vec2d e = m - v.m;
        a.x += (v.m22 * e.x - v.m12 * e.y) / v.jacobian;
        a.y += (v.m11 * e.y - v.m21 * e.x) / v.jacobian;
    }
    if (length(aim_.slopes.evaluate(rn, a, l).m - m) > 1e-6) return false;
    if (t.region[segment] > 0.5f)
        return columns_[segment].contain(a.x, a.y);
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    const Vec2d turned{c * a.x - s * a.y, s * a.x + c * a.y};
    return request_.iris.in_sampling_region(
        turned * (t.iris_scale / request_.iris_radius), kEnlargement);
}

/// Segments in which a fresh passing ray lies outside what is drawn, or the Jacobian
/// changes sign.
std::vector<bool> AimMaker::uncovered_segments() const {
    std::vector<bool> bad(kRadialSegments);
    const AimTables& t = aim_.tables;
    for (int i = 0; i < kRadialSegments; ++i) bad[i] = !jacobian_ok_[i];
    auto film = std::make_unique<FilmRays>();
    auto out = std::make_unique<SceneRays>();
    for (int n = 0; n < kCoverageRays; n += kLensBatch) {
        std::array<double, kLensBatch> radius, azimuth;
        for (int i = 0; i < kLensBatch; ++i) {
            const auto q = quasi_random<4>(200000 + n + i);
            radius[i] = t.film_radius * q[0];
            azimuth[i] = 2 * kPiD * std::fmod(q[1] * 97, 1.0);
            // Half of the rays crowd at the rim of the iris, where coverage is lost
            // first.
            Vec2d target = concentric_disc({q[1], q[2]});
            if (i % 2) target = target * (1 / std::max(1e-9, length(target)));
            target = target * (outer_ * (i % 2 ? 0.97 + 0.04 * q[2] : 1.2));
            const Vec2d m{rear_.slope_for(target.x, radius[i]),
                          rear_.slope_for(target.y, 0)};
            const double c = std::cos(azimuth[i]), s = std::sin(azimuth[i]);
            film->x[i] = float(c * radius[i]), film->y[i] = float(s * radius[i]);
            film->mx[i] = float(c * m.x - s * m.y),
            film->my[i] = float(s * m.x + c * m.y);
            film->nm[i] = float(380 + 400 * q[3]);
        }
        trace_to_scene(real_, *film, *out, kLensBatch);
        for (int i = 0; i < kLensBatch; ++i) {
            if (!(out->pass[i] > 0)) continue;
            const double c = std::cos(azimuth[i]), s = std::sin(azimuth[i]);
            const Vec2d m{c * film->mx[i] + s * film->my[i],
                          c * film->my[i] - s * film->mx[i]};
            const Vec2d iris{c * out->iris_x[i] + s * out->iris_y[i],
                             c * out->iris_y[i] - s * out->iris_x[i]};
            const int segment = std::min(
                kRadialSegments - 1, int(radius[i] / t.film_radius * kRadialSegments));
            if (!covers(segment, radius[i], m, iris, real_.scale(film->nm[i]),
                        azimuth[i]))
                bad[segment] = true;
        }
    }
    return bad;
}

Aim AimMaker::make() {
    std::vector<bool> bad(kRadialSegments, true);
    if (!request_.only_slope_boxes) {
        for (int k = kMinDegree; k <= kMaxDegree; ++k) {
            if (!fit(k)) break;
            choose_regions();
            bad = uncovered_segments();
            if (std::find(bad.begin(), bad.end(), true) == bad.end()) return aim_;
        }
    } else {
        fit(kMinDegree);
    }
    std::array<std::optional<Box>, kNodes> node;
    const auto box_at = [&](int i) {
        if (!node[i]) node[i] = slope_box(aim_.tables.film_radius * i / kRadialSegments);
        return *node[i];
    };
    for (int i = 0; i < kRadialSegments; ++i) {
        if (!bad[i]) continue;
        Box box = box_at(i);
        box.add(box_at(i + 1));
        box.grow(0.01 * (box.x1 - box.x0), 0.01 * box.half);
        set_region(i, AimRegion::slopes,
                   box.empty() ? Columns{} : rectangle(box.x0, box.x1, -box.half, box.half));
        ++aim_.fallback_segments;
    }
    return aim_;
}

}  // namespace

Aim make_aim(const Tracer& tracer, const AimRequest& request) {
    if (request.tilted || !is_axially_symmetric(tracer.prescription()))
        return make_free_aim(tracer, request);
    return AimMaker(tracer, request).make();
}

}  // namespace dg
