// trace_jacobian.cpp -- derivatives of the trace by automatic differentiation on dual numbers.
#include "optics/trace/lens_path.h"
#include "optics/trace/trace.h"

namespace dg {
namespace {

using Number = Dual<4>;

/// Ray with x, y, n L, n M as the independent variables.
RayOf<Number> dual_ray(const LensRay& ray, double n) {
    const Vec3d p = ray.origin, d = ray.direction;
    const Number l = Number::input(n * d.x, 2) / n, m = Number::input(n * d.y, 3) / n;
    const Number z = sqrt(Number(1) - l * l - m * m);
    return {{Number::input(p.x, 0), Number::input(p.y, 1), Number(p.z)},
            {l, m, d.z < 0 ? -z : z}};
}

}  // namespace

std::optional<RayJacobian> Tracer::jacobian(const LensRay& from, const LensIndices& n,
                                            double image_z) const {
    RayOf<Number> ray = dual_ray(from, n.index.front());
    for (std::size_t i = 0; i < forms_.size(); ++i)
        if (!pass(forms_[i], {int(i)}, n.index[i] / n.index[i + 1], ray)) return std::nullopt;
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
