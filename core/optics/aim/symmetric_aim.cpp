#include "optics/aim/symmetric_aim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "math/error.h"
#include "math/quasi_random.h"
#include "optics/aim/pupil_visible.h"
#include "optics/aim/symmetric_fit.h"

namespace dg {
namespace {

constexpr int kNodes = kRadialSegments + 1;
constexpr int kMinDegree = 3, kMaxDegree = 6;
constexpr int kCoverageRays = 16384;
// Margin of the outline, in iris radii, beyond the visible regions at the two ends of a segment.
constexpr double kOutlineMargin = 0.005;

class AimMaker {
  public:
    AimMaker(const Tracer& tracer, const AimRequest& request);
    Aim make();

  private:
    SlopeBox slope_box(double r) const;
    Columns rear_slopes(int segment) const;
    void choose_regions();
    void set_region(int segment, AimRegion region, const Columns& columns);
    std::vector<bool> uncovered_segments() const;
    bool covers(int segment, double r, Vec2d m, Vec2d iris, double l,
                double azimuth) const;
    double unit(double iris_mm) const { return iris_mm / aim_.tables.iris_scale; }
    /// Radius of the sampled iris, in units of iris_scale.
    double reach() const { return unit(outer_) * aim_.tables.enlargement / kEnlargement; }

    const AimRequest& request_;
    double outer_;  // mm, radius of the enlarged iris
    SymmetricRays rays_;
    LensTables open_;  // without the iris: the mounts only
    LensTables real_;
    std::array<bool, kRadialSegments> jacobian_ok_;
    std::array<Columns, kRadialSegments> columns_;
    Aim aim_;
};

AimMaker::AimMaker(const Tracer& tracer, const AimRequest& request)
    : request_(request), outer_(outer_radius(request)), rays_(tracer, request, outer_) {
    open_ = make_lens_tables(tracer, request.film_z, true, nullptr, 0);
    open_.semi2[tracer.stop()] = 3e38f;
    real_ = make_lens_tables(tracer, request.film_z, true, &request.iris,
                             request.iris_radius);
    AimTables& t = aim_.tables;
    t.film_radius = float(request.film_radius);
    set_iris_scale(t, request);
}

SlopeBox AimMaker::slope_box(double r) const {
    const auto range = [&](double reach) {
        const Vec2d a = rays_.slope(r, {reach * outer_, reach * outer_}),
                    b = rays_.slope(r, {-reach * outer_, -reach * outer_});
        return SlopeBox{std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y),
                        std::max(a.y, b.y)};
    };
    return passing_box(open_, {r, 0}, outer_, range);
}

/// Slopes toward the last surface, between its vertex and its rim, for the film radii of a segment:
/// columns that cover the discs seen from the segment's ends and from radii between.
Columns AimMaker::rear_slopes(int segment) const {
    constexpr int kSteps = 8, kPoints = 4 * kColumns + 1;
    const SurfaceForm& rear = rays_.tracer().form(
        int(rays_.tracer().prescription().surfaces.size()) - 1);
    if (!std::isfinite(rear.clear))
        throw input_error("exact lens", "rear disc", "a last surface with a clear radius", "none");
    std::vector<std::array<double, 2>> discs;  // centre and radius
    double reach = 0;
    for (int i = 0; i <= kSteps; ++i)
        for (int k = 0; k <= kSteps; ++k) {
            const double r = aim_.tables.film_radius * (segment + double(i) / kSteps) /
                             kRadialSegments,
                         away = request_.film_z - rear.place.origin.z +
                                rear.height * (1 - 2.0 * k / kSteps);
            discs.push_back({r / away, 1.02 * rear.clear / away});
            reach = std::max(reach, discs.back()[0] + discs.back()[1]);
        }
    Outline seen = Outline::dark(reach, kPoints);
    for (int i = 0; i < kPoints; ++i)
        for (const auto& [middle, radius] : discs) {
            const double x = seen.x(i) - middle;
            if (std::abs(x) < radius)
                seen.high[i] = std::max(seen.high[i], std::sqrt(radius * radius - x * x));
        }
    for (int i = 0; i < kPoints; ++i)
        if (seen.high[i] > 0) seen.low[i] = -seen.high[i];
    return cover(seen);
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
    const double orientation = aim_.slopes.evaluate(0, {0, 0}, 0).jacobian;
    for (int i = 0; i < kNodes; ++i)
        at[i] = visible_half_iris(open_, t, t.film_radius * i / kRadialSegments, reach(),
                                  orientation);
    for (int i = 0; i < kRadialSegments; ++i) {
        jacobian_ok_[i] = at[i].jacobian_ok && at[i + 1].jacobian_ok;
        const Columns seen =
            cover(at[i].outline.joined(at[i + 1].outline, kOutlineMargin * reach()));
        const bool smaller = seen.area < 0.97 * t.shape_area;
        set_region(i, smaller ? AimRegion::visible : AimRegion::shape, seen);
    }
}

/// Whether the aim's sampling domain contains a passing ray. `azimuth` rotates the meridian against
/// the iris shape.
bool AimMaker::covers(int segment, double r, Vec2d m, Vec2d iris, double l,
                      double azimuth) const {
    const AimTables& t = aim_.tables;
    const double rn = r / t.film_radius;
    Vec2d a{unit(iris.x), unit(iris.y)};
    for (int step = 0; step < 3; ++step) {  // Newton's method for the iris point of the aim's polynomial
        const SlopeValue v = aim_.slopes.evaluate(rn, a, l);
        a = a + v.step(m - v.m);
    }
    if (length(aim_.slopes.evaluate(rn, a, l).m - m) > 1e-6) return false;
    if (t.region[segment] > 0.5f)
        return columns_[segment].contain(a.x, a.y);
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    const Vec2d turned{c * a.x - s * a.y, s * a.x + c * a.y};
    return request_.iris.in_sampling_region(
        turned * (t.iris_scale / request_.iris_radius), t.enlargement);
}

/// Segments with an unsampled passing ray among fresh random rays, or with a sign change of the
/// Jacobian.
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
            // Half of the rays are near the rim of the iris, where coverage fails first.
            Vec2d target = concentric_disc({q[1], q[2]});
            if (i % 2) target = target * (1 / std::max(1e-9, length(target)));
            target = target * (outer_ * (i % 2 ? 0.97 + 0.04 * q[2] : 1.2));
            const Vec2d m = rays_.slope(radius[i], target);
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
    std::optional<Aim> best;
    const auto count = [](const std::vector<bool>& b) { return std::count(b.begin(), b.end(), true); };
    if (request_.draw == PupilDraw::aimed) {
        for (int k = kMinDegree; k <= kMaxDegree; ++k) {
            if (!rays_.fit(aim_, k)) break;
            choose_regions();
            const std::vector<bool> now = uncovered_segments();
            if (k > kMinDegree && count(now) >= count(bad)) continue;
            bad = now, best = aim_;
            if (count(bad) == 0) return aim_;
        }
        if (best) aim_ = *best;
    } else {
        rays_.fit(aim_, kMinDegree);
    }
    if (request_.draw == PupilDraw::rear_disc) {
        for (int i = 0; i < kRadialSegments; ++i)
            set_region(i, AimRegion::slopes, rear_slopes(i));
        return aim_;
    }
    std::array<std::optional<SlopeBox>, kNodes> node;
    const auto box_at = [&](int i) {
        if (!node[i]) node[i] = slope_box(aim_.tables.film_radius * i / kRadialSegments);
        return *node[i];
    };
    for (int i = 0; i < kRadialSegments; ++i) {
        if (!bad[i]) continue;
        SlopeBox box = box_at(i);
        box.add(box_at(i + 1));
        const double half = std::max(-box.y0, box.y1);
        box.grow(0.01 * (box.x1 - box.x0), 0);
        set_region(i, AimRegion::slopes,
                   box.empty() ? Columns{} : rectangle(box.x0, box.x1, -1.01 * half, 1.01 * half));
        ++aim_.fallback_segments;
    }
    return aim_;
}

}  // namespace

Aim make_symmetric_aim(const Tracer& tracer, const AimRequest& request) {
    return AimMaker(tracer, request).make();
}

}  // namespace dg
