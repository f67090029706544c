// trace_jacobian.cpp -- derivatives of a trace, by the same functions on dual numbers.
#include "optics/intersect.h"
#include "optics/trace.h"

namespace dg {
namespace {

using Number = Dual<4>;

/// x, y, n L, n M as the inputs.
struct DualRay {
    Vec3<Number> origin, direction;

    DualRay(const Vec3<Number>& o, const Vec3<Number>& d) : origin(o), direction(d) {}
    DualRay(const LensRay& ray, double n) {
        const Vec3d p = ray.origin, d = ray.direction;
        origin = {Number::input(p.x, 0), Number::input(p.y, 1), Number(p.z)};
        const Number l = Number::input(n * d.x, 2) / n, m = Number::input(n * d.y, 3) / n;
        const Number z = sqrt(Number(1) - l * l - m * m);
        direction = {l, m, d.z < 0 ? -z : z};
    }
};

bool pass(const SurfaceForm& form, double mu, DualRay& ray) {
    const Vec3<Number> d = form.place.turn_in(ray.direction);
    const auto hit = meet(form, form.place.into(ray.origin), d, 1);
    if (!hit) return false;
    Number cosine;
    const auto bent = refract(d, *hit, 1, mu, cosine);
    if (!bent) return false;
    ray = {form.place.out_of(hit->point), form.place.turn_out(*bent)};
    return true;
}

}  // namespace

std::optional<RayJacobian> Tracer::jacobian(const LensRay& from, const LensIndices& n,
                                            double image_z) const {
    DualRay ray(from, n.index.front());
    for (std::size_t i = 0; i < forms_.size(); ++i)
        if (!pass(forms_[i], n.index[i] / n.index[i + 1], ray)) return std::nullopt;
    const Number t = (Number(image_z) - ray.origin.z) / ray.direction.z;
    const Vec3<Number> there = ray.origin + t * ray.direction;
    const double after = n.index.back();
    const Number out[4] = {there.x, there.y, after * ray.direction.x,
                           after * ray.direction.y};
    RayJacobian j;
    for (int row = 0; row < 4; ++row) j[row] = out[row].d;
    return j;
}

}  // namespace dg
