// trace-inl.h -- one surface after the other, in SIMD lanes. Included once per
// instruction set.
#if defined(DG_OPTICS_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DG_OPTICS_TRACE_INL_H_
#undef DG_OPTICS_TRACE_INL_H_
#else
#define DG_OPTICS_TRACE_INL_H_
#endif

#include "hwy/highway.h"
#include "optics/pupil_tables.h"
#include "optics/transmission-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dg {
namespace HWY_NAMESPACE {
/// Rays on their way; z is measured from the vertex of the surface at hand.
struct LaneRays {
    V x, y, z, dx, dy, dz;
    V l, inv_um;  // wavelength variable, 1/lambda
    V n;          // index of the medium that they are in
    V transmittance;
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
    r.inv_um = hn::Div(constant(1e3f), nm);
    r.l = hn::MulAdd(hn::Mul(r.inv_um, r.inv_um), constant(lens.scale.scale),
                     constant(lens.scale.offset));
}

/// Iris transmission at a point, mm (stop.h). All shapes are loops over uniform tables.
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

/// Tracer::cross in lanes; kSign is +1 toward the film.
template <int kSign>
HWY_INLINE void cross_surface(const LensTables& lens, int i, LaneRays& r) {
    const D d;
    const V c = constant(lens.curvature[i]), zero = hn::Zero(d), one = constant(1);
    // Nearest point of the ray to the vertex.
    const V e = hn::MulAdd(r.x, r.dx, hn::MulAdd(r.y, r.dy, hn::Mul(r.z, r.dz)));
    const V mx = hn::NegMulAdd(e, r.dx, r.x), my = hn::NegMulAdd(e, r.dy, r.y);
    const V mz = hn::NegMulAdd(e, r.dz, r.z);
    const V m2 = hn::MulAdd(mx, mx, hn::MulAdd(my, my, hn::Mul(mz, mz)));
    const V q = hn::MulSub(c, m2, hn::Add(mz, mz));
    const V cos1_squared = hn::NegMulAdd(c, q, hn::Mul(r.dz, r.dz));
    const V cos1 = hn::Sqrt(cos1_squared);
    const V t = hn::Div(q, kSign > 0 ? hn::Add(r.dz, cos1) : hn::Sub(r.dz, cos1));
    r.x = hn::MulAdd(t, r.dx, mx);
    r.y = hn::MulAdd(t, r.dy, my);
    r.z = hn::MulAdd(t, r.dz, mz);
    const V toward_axis = hn::NegMulAdd(c, r.z, one);
    const V r2 = hn::MulAdd(r.x, r.x, hn::Mul(r.y, r.y));
    M ok = hn::And(hn::Ge(cos1_squared, zero), hn::Gt(toward_axis, zero));
    ok = hn::And(ok, hn::Le(r2, constant(lens.semi2[i])));
    if (i == lens.stop) {
        r.iris_x = r.x;
        r.iris_y = r.y;
        if (lens.iris.radius > 0) {
            const V open = iris_transmission(lens.iris, r.x, r.y);
            ok = hn::And(ok, hn::Gt(open, zero));
            r.transmittance = hn::Mul(r.transmittance, open);
        }
    }
    const V n2 = index_of(lens, kSign > 0 ? i + 1 : i, r.l);
    if (lens.light[i] != SurfaceLight::none || lens.curvature[i] != 0) {
        const V mu = hn::Div(r.n, n2);
        const V cos2_squared =
            hn::NegMulAdd(hn::Mul(mu, mu), hn::Sub(one, cos1_squared), one);
        const V cos2 = hn::Sqrt(cos2_squared);
        ok = hn::And(ok, hn::Ge(cos2_squared, zero));
        if (lens.light[i] != SurfaceLight::none) {
            const LaneCrossing at{r.n, cos1, cos1_squared, n2, cos2, r.l, r.inv_um};
            r.transmittance =
                hn::Mul(r.transmittance, transmission_lanes<kSign>(lens, i, at));
        }
        const V bend = hn::NegMulAdd(mu, cos1, cos2);
        const V g = kSign > 0 ? bend : hn::Neg(bend);
        const V gc = hn::Mul(g, c);
        r.dx = hn::NegMulAdd(gc, r.x, hn::Mul(mu, r.dx));
        r.dy = hn::NegMulAdd(gc, r.y, hn::Mul(mu, r.dy));
        r.dz = hn::MulAdd(g, toward_axis, hn::Mul(mu, r.dz));
    }
    r.n = n2;
    r.alive = hn::And(r.alive, ok);
}

/// Two vectors of rays at once, so that one's long chains of dependent operations hide
/// behind the other's. The rays start on the film, z = 0 there.
HWY_INLINE void lanes_to_scene(const LensTables& lens, LaneRays& a, LaneRays& b) {
    const int last = lens.surfaces - 1;
    a.n = index_of(lens, lens.surfaces, a.l);
    b.n = index_of(lens, lens.surfaces, b.l);
    a.transmittance = b.transmittance = constant(1);
    a.z = hn::Add(a.z, constant(lens.film_gap));
    b.z = hn::Add(b.z, constant(lens.film_gap));
    for (int i = last; i >= 0; --i) {
        if (i < last) {
            a.z = hn::Add(a.z, constant(lens.gap[i]));
            b.z = hn::Add(b.z, constant(lens.gap[i]));
        }
        cross_surface<-1>(lens, i, a);
        cross_surface<-1>(lens, i, b);
    }
}

/// Rays that travel toward the film; z from the first vertex. At the end z is from the
/// last vertex.
HWY_INLINE void lanes_to_film(const LensTables& lens, LaneRays& a, LaneRays& b) {
    a.n = index_of(lens, 0, a.l);
    b.n = index_of(lens, 0, b.l);
    a.transmittance = b.transmittance = constant(1);
    for (int i = 0; i < lens.surfaces; ++i) {
        if (i) {
            a.z = hn::Sub(a.z, constant(lens.gap[i - 1]));
            b.z = hn::Sub(b.z, constant(lens.gap[i - 1]));
        }
        cross_surface<1>(lens, i, a);
        cross_surface<1>(lens, i, b);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace dg
HWY_AFTER_NAMESPACE();
#endif
