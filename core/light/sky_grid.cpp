#include "light/sky_grid.h"

#include "math/fast_atan2.h"

namespace dg {

namespace {

float bilinear(const std::array<float, 4>& c, float x, float y) {
    const float top = c[0] + (c[1] - c[0]) * x, low = c[2] + (c[3] - c[2]) * x;
    return top + (low - top) * y;
}

/// Samples x in [0,1] with a density proportional to a + (b - a) x, by the inverse of its quadratic CDF in a form
/// without cancellation.
float sample_linear(float u, float a, float b) {
    if (a + b <= 0) return u;
    const float x =
        u * (a + b) / (a + std::sqrt(std::max(0.f, a * a + u * (b * b - a * a))));
    return std::isfinite(x) ? std::min(x, 1.f) : u;
}

}  // namespace

SkyGrid::SkyGrid(int width, int height, std::vector<float> luminance)
    : width(width), height(height), cos_edge(std::size_t(height) + 2),
      texels_(std::make_shared<const std::vector<float>>(std::move(luminance))) {
    cos_edge.front() = 1;
    cos_edge.back() = -1;
    for (int r = 1; r <= height; ++r) {
        cos_edge[r] = std::cos(kPiD * (r - 0.5) / height);
    }
}

SkyGrid SkyGrid::compensated(float mean) const {
    SkyGrid grid = *this;
    grid.subtracted_ = mean;
    return grid;
}

Vec3f SkyGrid::direction(double column, double cos_theta) const {
    const float sin_theta = float(std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta)));   // in double: near the poles
    const float phi = float(2 * kPiD * ((column + 0.5) / width - 0.5));  // 0 along -z
    return {sin_theta * std::sin(phi), float(cos_theta), -sin_theta * std::cos(phi)};
}

SkyDraw SkyGrid::sample_in(int c, int r, Vec2f u) const {
    const auto k = corners(c, r);
    const float s = sample_linear(u.y, k[0] + k[1], k[2] + k[3]);
    const float x = sample_linear(u.x, k[0] + (k[2] - k[0]) * s, k[1] + (k[3] - k[1]) * s);
    const double cos_theta = cos_edge[r] + (cos_edge[r + 1] - cos_edge[r]) * double(s);
    return {direction(c + double(x), cos_theta), bilinear(k, x, s)};
}

Vec3f SkyGrid::sample_even(std::array<int, 2> c, std::array<int, 2> r, Vec2d u) const {
    const double top = cos_edge[r[0]], low = cos_edge[r[1]];
    return direction(c[0] + (c[1] - c[0]) * u.x, top + (low - top) * u.y);
}

SkyTexels SkyGrid::texels(Vec3f d) const {
    const float turn = 0.5f + fast_atan2(d.x, -d.z) * (0.5f / kPi);
    const float theta = fast_atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y);
    return {std::clamp(turn, 0.f, 1.f) * float(width), theta * (1 / kPi) * float(height)};
}

SkyGrid::Place SkyGrid::place(SkyTexels at) const {
    const float column = std::floor(at.column - 0.5f);
    const int c = int(column), r = std::clamp(int(at.row + 0.5f), 0, height);
    return {wrap(c), r, at.column - 0.5f - column};
}

float SkyGrid::weight(const Place& at, Vec3f d) const {
    const double top = cos_edge[at.r], s = (top - double(d.y)) / (top - cos_edge[at.r + 1]);
    return bilinear(corners(at.c, at.r), at.x, std::clamp(float(s), 0.f, 1.f));
}

}  // namespace dg
