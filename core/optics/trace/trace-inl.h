// trace-inl.h -- sequential ray tracing through a lens in SIMD lanes. Included once per instruction
// set.
#if defined(DG_OPTICS_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_TRACE_INL_H_
#undef DG_OPTICS_TRACE_INL_H_
#else
#define DG_OPTICS_TRACE_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/trace/lens_tables.h"
#include "optics/trace/meet-inl.h"
#include "optics/trace/transmission-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {
/// State of rays inside the lens; z is relative to the vertex of the current surface.
struct LaneRays {
    V x, y, z, dx, dy, dz;
    V l;  // wavelength variable
    V n;  // index of the current medium
    V transmittance;
    V depth;  // optical depth in absorbing glass so far
    V iris_x, iris_y;
    M alive;
};

HWY_INLINE V index_of(const LensTables& lens, int medium, V l) {
    const float* c = lens.index.data() + medium * (lens.index_degree + 1);
    V n = constant(c[lens.index_degree]);
    for (int j = lens.index_degree - 1; j >= 0; --j) n = hn::MulAdd(n, l, constant(c[j]));
    return n;
}

HWY_INLINE void set_wavelength(const LensTables& lens, V nm, LaneRays& r) {
    const V inv_um = hn::Div(constant(1e3f), nm);
    r.l = hn::MulAdd(hn::Mul(inv_um, inv_um), constant(lens.scale.scale),
                     constant(lens.scale.offset));
}

/// Iris transmittance at a point in mm (stop.h). All shapes are loops over uniform tables.
HWY_INLINE V iris_transmission(const IrisTables& iris, V x, V y) {
    const D d;
    if (iris.kind == Iris::Kind::round) {
        const V r2 = hn::MulAdd(x, x, hn::Mul(y, y));
        return hn::IfThenElseZero(hn::Le(r2, constant(iris.radius * iris.radius)),
                                  constant(1));
    }
    if (iris.kind == Iris::Kind::image) {
        const V inv = constant(1 / iris.pixel);
        const V px = hn::Floor(hn::MulAdd(x, inv, constant(0.5f * iris.width)));
        const V py = hn::Floor(hn::NegMulAdd(y, inv, constant(0.5f * iris.height)));
        const M in_x =
            hn::And(hn::Ge(px, hn::Zero(d)), hn::Lt(px, constant(float(iris.width))));
        const M in_y =
            hn::And(hn::Ge(py, hn::Zero(d)), hn::Lt(py, constant(float(iris.height))));
        const M inside = hn::And(in_x, in_y);
        const V at =
            hn::IfThenElseZero(inside, hn::MulAdd(py, constant(float(iris.width)), px));
        return hn::IfThenElseZero(
            inside, hn::GatherIndex(d, iris.values.data(), hn::ConvertTo(DI(), at)));
    }
    M inside = hn::Eq(x, x);
    for (std::size_t i = 0; i < iris.edge_x.size(); ++i) {
        const V ex = constant(iris.edge_x[i]), ey = constant(iris.edge_y[i]);
        if (iris.bend <= 0) {
            const V along = hn::MulAdd(ex, x, hn::Mul(ey, y));
            inside = hn::And(inside, hn::Le(along, constant(iris.apothem)));
        }
        if (iris.bend == 0) continue;
        const V ox = hn::NegMulAdd(ex, constant(iris.center), x);
        const V oy = hn::NegMulAdd(ey, constant(iris.center), y);
        const V d2 = hn::MulAdd(ox, ox, hn::Mul(oy, oy)), r2 = constant(iris.arc_radius2);
        inside = hn::And(inside, iris.bend > 0 ? hn::Le(d2, r2) : hn::Ge(d2, r2));
    }
    return hn::IfThenElseZero(inside, constant(1));
}

/// Accumulates absorption in a medium from the ray's position to a point; free for clear glass.
HWY_INLINE void swallow(const LensTables& lens, int medium, const LaneVec& to, LaneRays& r) {
    if (lens.absorption.absorbs.empty() || !lens.absorption.absorbs[medium]) return;
    const V path = hn::MulAdd(
        hn::Sub(to.x, r.x), r.dx,
        hn::MulAdd(hn::Sub(to.y, r.y), r.dy, hn::Mul(hn::Sub(to.z, r.z), r.dz)));
    r.depth = hn::MulAdd(absorption_lanes(lens.absorption, medium, r.l), path, r.depth);
}

HWY_INLINE void start_transmittance(LaneRays& r) {
    r.transmittance = constant(1);
    r.depth = hn::Zero(D());
}

HWY_INLINE void finish_transmittance(const LensTables& lens, LaneRays& r) {
    if (lens.absorption.absorbs.empty()) return;
    r.transmittance = hn::Mul(r.transmittance, hn::Exp(D(), hn::Neg(r.depth)));
}

/// Moves rays to their hits, adds the absorption on the way, and clips them at apertures.
template <int kSign>
HWY_INLINE M stop_at_surface(const LensTables& lens, int i, const LaneHit& hit, LaneRays& r) {
    const V x = hit.point.x, y = hit.point.y;
    swallow(lens, kSign > 0 ? i : i + 1, hit.point, r);
    r.x = x, r.y = y, r.z = hit.point.z;
    const V r2 = hn::MulAdd(x, x, hn::Mul(y, y));
    M ok = hn::And(hit.ok, hn::Le(r2, constant(lens.semi2[i])));
    if (lens.inner2[i] > 0) ok = hn::And(ok, hn::Ge(r2, constant(lens.inner2[i])));
    if (i == lens.stop) {
        r.iris_x = x, r.iris_y = y;
        if (lens.iris.radius > 0) {
            const V open = iris_transmission(lens.iris, x, y);
            ok = hn::And(ok, hn::Gt(open, hn::Zero(D())));
            r.transmittance = hn::Mul(r.transmittance, open);
        }
    }
    return ok;
}

/// Finishes Tracer::cross after the intersection: clipping and refraction.
template <int kSign>
HWY_INLINE void pass_surface(const LensTables& lens, int i, const LaneHit& hit,
                             LaneRays& r) {
    const V one = constant(1), x = hit.point.x, y = hit.point.y;
    M ok = stop_at_surface<kSign>(lens, i, hit, r);
    const V n2 = index_of(lens, kSign > 0 ? i + 1 : i, r.l);
    if (lens.refracts[i]) {
        const V mu = hn::Div(r.n, n2);
        const V cos2_squared =
            hn::NegMulAdd(hn::Mul(mu, mu), hn::Sub(one, hit.cos1_squared), one);
        const V cos2 = hn::Sqrt(cos2_squared);
        ok = hn::And(ok, hn::Ge(cos2_squared, hn::Zero(D())));
        if (lens.fresnel[i] != FresnelModel::none) {
            const LaneCrossing at{r.n, hit.cos1, n2, cos2, r.l};
            r.transmittance =
                hn::Mul(r.transmittance, transmission_lanes<kSign>(lens, i, at));
        }
        const V g = signed_by<kSign>(hn::NegMulAdd(mu, hit.cos1, cos2));
        r.dx = hn::NegMulAdd(hn::Mul(g, hit.bend_x), x, hn::Mul(mu, r.dx));
        r.dy = hn::NegMulAdd(hn::Mul(g, hit.bend_y), y, hn::Mul(mu, r.dy));
        r.dz = hn::MulAdd(g, hit.axial, hn::Mul(mu, r.dz));
    }
    r.n = n2;
    r.alive = hn::And(r.alive, ok);
}

/// Transforms rays into the frame of a displaced or rotated surface, and back.
HWY_INLINE void enter_frame(const ShapeTables& s, LaneRays& r) {
    const auto turn = [&](V& x, V& y, V& z) {
        const auto row = [&](const float* a) {
            return hn::MulAdd(constant(a[0]), x,
                              hn::MulAdd(constant(a[1]), y, hn::Mul(constant(a[2]), z)));
        };
        const V u = row(s.axis[0]), v = row(s.axis[1]), w = row(s.axis[2]);
        x = u, y = v, z = w;
    };
    r.x = hn::Sub(r.x, constant(s.shift[0])), r.y = hn::Sub(r.y, constant(s.shift[1]));
    r.z = hn::Sub(r.z, constant(s.shift[2]));
    turn(r.x, r.y, r.z), turn(r.dx, r.dy, r.dz);
}

HWY_INLINE void leave_frame(const ShapeTables& s, LaneRays& r) {
    const auto turn = [&](V& x, V& y, V& z) {
        const auto column = [&](int k) {
            return hn::MulAdd(constant(s.axis[0][k]), x,
                              hn::MulAdd(constant(s.axis[1][k]), y,
                                         hn::Mul(constant(s.axis[2][k]), z)));
        };
        const V u = column(0), v = column(1), w = column(2);
        x = u, y = v, z = w;
    };
    turn(r.x, r.y, r.z), turn(r.dx, r.dy, r.dz);
    r.x = hn::Add(r.x, constant(s.shift[0])), r.y = hn::Add(r.y, constant(s.shift[1]));
    r.z = hn::Add(r.z, constant(s.shift[2]));
}

/// Tilts the normal by the slope of the ripple (ripple.h).
template <int kSign>
HWY_INLINE void lean_lanes(const ShapeTables& s, const LaneVec& d, LaneHit& h) {
    const VI last = hn::Set(DI(), int(s.ripple.size()) - 2);
    const V r = hn::Sqrt(hn::MulAdd(h.point.x, h.point.x, hn::Mul(h.point.y, h.point.y)));
    const V x = hn::Mul(r, constant(s.ripple_steps_per_mm));
    const VI i = hn::Max(hn::Min(hn::ConvertTo(DI(), x), last), hn::Zero(DI()));
    const V below = hn::GatherIndex(D(), s.ripple.data(), i);
    const V above = hn::GatherIndex(D(), s.ripple.data() + 1, i);
    const V slope = hn::MulAdd(hn::Sub(x, hn::ConvertTo(D(), i)), hn::Sub(above, below), below);
    const V e = hn::Div(slope, hn::Max(r, constant(1e-6f)));
    h.bend_x = hn::Add(h.bend_x, e), h.bend_y = hn::Add(h.bend_y, e);
    const V speed = hn::NegMulAdd(
        hn::Mul(h.bend_x, h.point.x), d.x,
        hn::NegMulAdd(hn::Mul(h.bend_y, h.point.y), d.y, hn::Mul(h.axial, d.z)));
    normalize_hit<kSign>(speed, h);
}

/// Intersects rays with forms other than centred planes and spheres. Leaves the rays in the
/// surface's frame.
template <int kSign>
HWY_INLINE void meet_other(const LensTables& lens, int i, LaneRays& a, LaneRays& b, LaneHit (&hit)[2]) {
    const ShapeTables& s = lens.shape[i];
    if (s.placed) enter_frame(s, a), enter_frame(s, b);
    const LaneVec p[2] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}};
    const LaneVec d[2] = {{a.dx, a.dy, a.dz}, {b.dx, b.dy, b.dz}};
    if (s.quadric) {
        for (int v = 0; v < 2; ++v) hit[v] = meet_quadric<kSign>(s, p[v], d[v]);
    } else {
        const M alive[2] = {a.alive, b.alive};
        meet_searched<kSign>(s, p, d, alive, hit);
    }
    if (!s.ripple.empty())
        for (int v = 0; v < 2; ++v) lean_lanes<kSign>(s, d[v], hit[v]);
}

/// Crosses other forms, out of line so that planes and spheres stay fast.
template <int kSign>
HWY_NOINLINE void cross_other(const LensTables& lens, int i, LaneRays& a, LaneRays& b) {
    const ShapeTables& s = lens.shape[i];
    LaneHit hit[2];
    meet_other<kSign>(lens, i, a, b, hit);
    pass_surface<kSign>(lens, i, hit[0], a);
    pass_surface<kSign>(lens, i, hit[1], b);
    if (s.placed) leave_frame(s, a), leave_frame(s, b);
}

/// Tracer::cross in lanes; kSign is +1 toward the film.
template <int kSign>
HWY_INLINE void cross_surface(const LensTables& lens, int i, LaneRays& a, LaneRays& b) {
    const auto both = [&](auto meet) {
        pass_surface<kSign>(lens, i, meet({a.x, a.y, a.z}, {a.dx, a.dy, a.dz}), a);
        pass_surface<kSign>(lens, i, meet({b.x, b.y, b.z}, {b.dx, b.dy, b.dz}), b);
    };
    switch (lens.intersection[i]) {
        case Intersection::plane:
            return both([](const LaneVec& p, const LaneVec& d)
                            HWY_ATTR { return meet_plane<kSign>(p, d); });
        case Intersection::sphere:
            return both([&](const LaneVec& p, const LaneVec& d) HWY_ATTR {
                return meet_sphere<kSign>(lens.curvature[i], p, d);
            });
        default:
            cross_other<kSign>(lens, i, a, b);
    }
}

/// Traces two vectors of rays to the scene, interleaved so that the latency of dependent operations
/// is hidden. Rays start on the film at z = 0.
HWY_INLINE void lanes_to_scene(const LensTables& lens, LaneRays& a, LaneRays& b) {
    const int last = lens.surfaces - 1;
    a.n = index_of(lens, lens.surfaces, a.l);
    b.n = index_of(lens, lens.surfaces, b.l);
    start_transmittance(a), start_transmittance(b);
    a.z = hn::Add(a.z, constant(lens.film_gap));
    b.z = hn::Add(b.z, constant(lens.film_gap));
    for (int i = last; i >= 0; --i) {
        if (i < last) {
            a.z = hn::Add(a.z, constant(lens.gap[i]));
            b.z = hn::Add(b.z, constant(lens.gap[i]));
        }
        cross_surface<-1>(lens, i, a, b);
    }
    finish_transmittance(lens, a), finish_transmittance(lens, b);
}

/// Traces rays toward the film. z is relative to the first vertex at the start and to the last
/// vertex at the end.
HWY_INLINE void lanes_to_film(const LensTables& lens, LaneRays& a, LaneRays& b) {
    a.n = index_of(lens, 0, a.l);
    b.n = index_of(lens, 0, b.l);
    start_transmittance(a), start_transmittance(b);
    for (int i = 0; i < lens.surfaces; ++i) {
        if (i) {
            a.z = hn::Sub(a.z, constant(lens.gap[i - 1]));
            b.z = hn::Sub(b.z, constant(lens.gap[i - 1]));
        }
        cross_surface<1>(lens, i, a, b);
    }
    finish_transmittance(lens, a), finish_transmittance(lens, b);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
