// beckmann.cpp -- the normal distribution of slopes, and sampling of visible slopes.
#include "material/beckmann.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

constexpr float kSqrtPi = 1.77245385f;
constexpr float kFarthest = 4.2f;   // largest slope in units of alpha that float random numbers sample

float polynomial(float x, std::initializer_list<float> coefficients) {
    float sum = 0;
    for (const float c : coefficients) sum = sum * x + c;
    return sum;
}

/// cos (1 + 2 Lambda) = cos erf(a) + exp(-a^2) spread / sqrt(pi) with a = cos / spread; `spread` is alpha sin.
float slope_of(float cosine, float spread) {
    if (cosine > kFarthest * spread) return cosine;
    const float a = cosine / spread, gauss = std::exp(-a * a);
    return cosine * error_function(a, gauss) + spread * gauss / kSqrtPi;
}

/// Samples slopes toward a direction with this cosine and sine, in units of alpha. The density is
/// (cos + s sin) exp(-s^2) for s > -cot; the bracket is proportional to the projected area of the facet. Inverts the
/// CDF by Newton's method, safeguarded by bisection.
float sample_slope_toward(float cosine, float sine, float u) {
    const float cot = std::min(cosine / std::max(sine, 1e-6f), kFarthest), far = std::exp(-cot * cot);
    const float erf_cot = error_function(cot, far), even = cosine * 0.5f, tilted = sine / (2 * kSqrtPi);
    const float wanted = u * (even * (1 + erf_cot) + tilted * far);
    float low = -cot, high = kFarthest;
    float s = std::clamp(inverse_error_function(2 * u - 1) + 0.5f * sine, low, high);
    for (int i = 0; i < 20; ++i) {
        const float gauss = std::exp(-s * s);
        const float excess = even * (error_function(s, gauss) + erf_cot) + tilted * (far - gauss) - wanted;
        (excess > 0 ? high : low) = s;
        const float density = (cosine + s * sine) * gauss / kSqrtPi;
        float next = s - excess / density;
        if (!(next > low && next < high)) next = 0.5f * (low + high);
        const float step = next - s;
        s = next;
        if (std::abs(step) < 1e-5f) break;
    }
    return s;
}

}  // namespace

float error_function(float x, float gauss) {
    const float t = 1 / (1 + 0.3275911f * std::abs(x));
    const float tail =
        t * polynomial(t, {1.061405429f, -1.453152027f, 1.421413741f, -0.284496736f, 0.254829592f}) * gauss;
    return std::copysign(1 - tail, x);
}

float inverse_error_function(float y) {
    y = std::clamp(y, -0.9999999f, 0.9999999f);
    const float w = -std::log((1 - y) * (1 + y));
    if (w < 5)
        return y * polynomial(w - 2.5f, {2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f,
                                         0.00021858087f, -0.00125372503f, -0.00417768164f, 0.246640727f, 1.50140941f});
    return y * polynomial(std::sqrt(w) - 3, {-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f,
                                             0.00573950773f, -0.0076224613f, 0.00943887047f, 1.00167406f, 2.83297682f});
}

float StretchedBeckmann::d(Vec3f n, Vec3f h, float h2) const {
    const float c = dot(n, h), c2 = c * c;
    if (!(c2 > 0)) return 0;
    const float t = dot(tangent, h) / alpha_t, b = dot(bitangent, h) / alpha_b, steep = (t * t + b * b) / c2;
    if (!(steep < 80)) return 0;   // negligible, and would be 0 times infinity below
    const float whole = h2 / c2;
    return whole * whole * std::exp(-steep) / (kPi * alpha_t * alpha_b);
}

float StretchedBeckmann::slope(Vec3f w, float cos_w) const {
    const float t = alpha_t * dot(tangent, w), b = alpha_b * dot(bitangent, w);
    return slope_of(std::abs(cos_w), std::sqrt(t * t + b * b));
}

float beckmann_slope(float alpha, float cosine) {
    return slope_of(cosine, alpha * std::sqrt(std::max(0.f, 1 - cosine * cosine)));
}

Vec3f sample_visible_beckmann(const Frame& frame, Vec3f wo, Vec2f alpha, Vec2f u) {
    const Vec3f v = frame.to_local(wo), toward = normalize(Vec3f{alpha.x * v.x, alpha.y * v.y, v.z});
    const float sine = std::sqrt(toward.x * toward.x + toward.y * toward.y);
    const Vec2f azimuth = sine > 0 ? Vec2f{toward.x / sine, toward.y / sine} : Vec2f{1, 0};
    const float s = sample_slope_toward(toward.z, sine, u.x), across = inverse_error_function(2 * u.y - 1);
    return frame.to_world(normalize(Vec3f{alpha.x * (s * azimuth.x - across * azimuth.y),
                                          alpha.y * (s * azimuth.y + across * azimuth.x), 1}));
}

}  // namespace dg
