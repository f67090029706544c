#include "motion/decompose.h"

#include <cmath>

namespace dg {
namespace {

constexpr double kOrthogonal = 1e-5;   // |cosine| between axes: matrices from glTF have float precision

Affine3d linear_part(const Affine3d& m) {
    return {m.x, m.y, m.z, {}};
}
Affine3d scaled(const Affine3d& m, double s) {
    return {m.x * s, m.y * s, m.z * s, {}};
}
Affine3d transposed(const Affine3d& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}, {}};
}
/// Length of the longest column.
double size(const Affine3d& m) {
    return std::sqrt(std::max({length_squared(m.x), length_squared(m.y), length_squared(m.z)}));
}

}  // namespace

std::optional<RotationStretch> polar(const Affine3d& m) {
    const double scale = size(m);
    if (!(scale > 0) || !std::isfinite(scale)) return std::nullopt;
    const Affine3d unit = scaled(linear_part(m), 1 / scale);
    Affine3d r = unit;
    for (int i = 0; i < 100; ++i) {
        if (!(std::abs(r.determinant()) > 1e-12)) return std::nullopt;
        const Affine3d back = transposed(inverse(r));
        // Scaling the iterates by their sizes makes ill-conditioned matrices converge.
        const double g = i < 8 ? std::sqrt(size(back) / size(r)) : 1;
        const Affine3d next{(r.x * g + back.x / g) * 0.5, (r.y * g + back.y / g) * 0.5,
                            (r.z * g + back.z / g) * 0.5, {}};
        const double step = length(next.x - r.x) + length(next.y - r.y) + length(next.z - r.z);
        r = next;
        if (step < 1e-14) break;
    }
    const double side = r.determinant() < 0 ? -1 : 1;
    r = scaled(r, side);
    const Affine3d s = transposed(r) * linear_part(m);
    const Vec3d off{(s.y.x + s.x.y) / 2, (s.z.x + s.x.z) / 2, (s.z.y + s.y.z) / 2};
    return RotationStretch{from_matrix(r),
                           {{s.x.x, off.x, off.y}, {off.x, s.y.y, off.z}, {off.y, off.z, s.z.z}, {}}};
}

std::optional<RotationStretch> scaled_rotation(const Affine3d& m) {
    const double x = length(m.x), y = length(m.y), z = length(m.z);
    const double volume = x * y * z;
    if (!(volume > 0) || !std::isfinite(volume)) return std::nullopt;
    if (std::abs(dot(m.x, m.y)) > kOrthogonal * x * y ||
        std::abs(dot(m.y, m.z)) > kOrthogonal * y * z ||
        std::abs(dot(m.z, m.x)) > kOrthogonal * z * x)
        return std::nullopt;
    const double side = m.determinant() < 0 ? -1 : 1;
    return RotationStretch{from_matrix(Affine3d{m.x / (side * x), m.y / y, m.z / z, {}}),
                           {{side * x, 0, 0}, {0, y, 0}, {0, 0, z}, {}}};
}

// Largest eigenvalue of M^T M in closed form. Source: Smith 1961, Eigenvalues of a symmetric 3x3
// matrix, Comm. ACM 4(4).
double spectral_norm(const Affine3d& m) {
    const double xx = dot(m.x, m.x), yy = dot(m.y, m.y), zz = dot(m.z, m.z);
    const double xy = dot(m.x, m.y), yz = dot(m.y, m.z), zx = dot(m.z, m.x);
    const double mean = (xx + yy + zz) / 3;
    const Vec3d d{xx - mean, yy - mean, zz - mean};
    const double p = std::sqrt((dot(d, d) + 2 * (xy * xy + yz * yz + zx * zx)) / 6);
    if (!(p > 1e-12 * mean)) return std::sqrt(std::max(mean, 0.0));
    const Affine3d b{{d.x / p, xy / p, zx / p}, {xy / p, d.y / p, yz / p}, {zx / p, yz / p, d.z / p}, {}};
    const double angle = acos(std::clamp(b.determinant() / 2, -1.0, 1.0)) / 3;
    return std::sqrt(mean + 2 * p * std::cos(angle));
}

}  // namespace dg
