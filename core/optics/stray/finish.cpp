#include "optics/stray/finish.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

constexpr int kSteps = 64;               // albedo table, over the cosine
constexpr int kAround = 16, kOut = 24;   // quadrature points of the albedo: over half of the azimuth, and radial

/// Schlick's reflectance for a binder of index 1.5, relative to 0.04 at normal incidence.
double growth(double cosine) {
    const double m = 1 - cosine;
    return 1 + 24 * m * m * m * m * m;
}

/// Cosine of incidence on the microfacet that mirrors `in` to `out`.
double facet_cosine(const Vec3d& in, const Vec3d& out) {
    return std::sqrt(std::clamp(0.5 * (1 + dot(in, out)), 0.0, 1.0));
}

/// Direction cosines of the mirror direction.
Vec2d mirrored(const Vec3d& in) {
    return {-in.x, -in.y};
}

Vec3d raised(Vec2d b) {
    return {b.x, b.y, std::sqrt(std::max(0.0, 1 - dot(b, b)))};
}

}  // namespace

FinishScatter::FinishScatter(const Finish& finish, const char* where) : finish_(finish) {
    const auto share = [&](const char* what, double value) {
        if (!(value >= 0 && value <= 1))
            throw input_error("scatter", std::string(where) + ", " + what, "a share of light, 0 to 1",
                              std::to_string(value));
    };
    share("diffuse", finish.diffuse), share("gloss", finish.gloss);
    check_lobe(finish.lobe, where);
    scale_ = finish.gloss / finish.lobe.within(1);
    for (int i = 0; i <= kSteps; ++i)
        albedo_.push_back(finish.diffuse + glossy_albedo(double(i) / kSteps));
    const double most = *std::ranges::max_element(albedo_);
    if (most > 1 + 1e-6)
        throw input_error("scatter", where, "a finish that reflects at most all light",
                          std::to_string(most) + " of it at one angle");
}

/// Integrates the lobe: uniformly in azimuth over one half (the other is its mirror image), and
/// radially by equal shares of the lobe.
double FinishScatter::glossy_albedo(double cosine) const {
    if (finish_.gloss == 0) return 0;
    const Vec3d in{std::sqrt(1 - cosine * cosine), 0, cosine};
    double sum = 0;
    for (int k = 0; k < kAround; ++k)
        for (int j = 0; j < kOut; ++j) {
            const Vec2d u{(j + 0.5) / kOut, 0.5 * (k + 0.5) / kAround};
            const Vec2d b = finish_.lobe.sample(mirrored(in), 1, u);
            const double pdf = finish_.lobe.pdf(mirrored(in), 1, b);
            if (pdf > 0)
                sum += growth(facet_cosine(in, raised(b))) * finish_.lobe.at(length(b - mirrored(in))) / pdf;
        }
    return scale_ * sum / (kAround * kOut);
}

double FinishScatter::albedo(double cosine) const {
    const double x = cosine > 0 ? std::min(cosine, 1.0) * kSteps : 0;   // NaN gives 0
    const int i = std::min(int(x), kSteps - 1);
    return albedo_[i] + (x - i) * (albedo_[i + 1] - albedo_[i]);
}

double FinishScatter::value(const Vec3d& in, const Vec3d& out) const {
    if (!(in.z > 0 && out.z > 0)) return 0;
    const double lobe = finish_.lobe.at(length(Vec2d{out.x, out.y} - mirrored(in)));
    return finish_.diffuse / kPiD + scale_ * growth(facet_cosine(in, out)) * lobe;
}

double FinishScatter::lobe_chance(double cosine) const {
    const double all = albedo(cosine);
    return all > 0 ? 1 - finish_.diffuse / all : 0;
}

Vec3d FinishScatter::sample(const Vec3d& in, double u_lobe, Vec2d u) const {
    if (u_lobe < lobe_chance(in.z)) return raised(finish_.lobe.sample(mirrored(in), 1, u));
    const double r = std::sqrt(u.x), phi = 2 * kPiD * u.y;
    return raised({r * std::cos(phi), r * std::sin(phi)});
}

double FinishScatter::pdf(const Vec3d& in, const Vec3d& out) const {
    if (!(out.z > 0)) return 0;
    const double chance = lobe_chance(in.z);
    const double lobe = chance > 0 ? finish_.lobe.pdf(mirrored(in), 1, {out.x, out.y}) : 0;
    return out.z * ((1 - chance) / kPiD + chance * lobe);
}

}  // namespace dg
