#include "render/flare/maps/color_table.h"

#include <algorithm>
#include <cmath>

namespace dg {
namespace {

constexpr int kNodes = Responses::kNodes;
constexpr Rgb kParts[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr int kPerNm = 4;   // integration steps

/// Cumulative sums over nm of D65's luminance and of the luminance curve.
struct Sums {
    double white = 0, curve = 0;
    Sums() {
        for (int k = 0; k < kNodes; ++k) {
            const double y = cie_y(kMinWavelength + k);
            white += d65(kMinWavelength + k) * y, curve += y;
        }
    }
};

}  // namespace

float seen_light(float nm) {
    static const auto at_nm = [] {
        std::array<float, kNodes> seen{};
        double sum = 0;
        for (int k = 0; k < kNodes; ++k) {
            const double wave = kMinWavelength + k, pdf = wavelength_pdf(float(wave));
            const Rgb rgb = rgb_from_xyz({float(cie_x(wave)), float(cie_y(wave)), float(cie_z(wave))});
            const double all = d65(wave) * double(std::abs(rgb.x) + std::abs(rgb.y) + std::abs(rgb.z));
            seen[k] = pdf > 0 ? float(all / pdf) : 0, sum += all;
        }
        for (float& v : seen) v = float(v / sum);
        return seen;
    }();
    return at_nm[std::size_t(std::clamp(std::lround(nm - kMinWavelength), 0l, long(kNodes - 1)))];
}

/// Scaled like Wavelengths: Rgb 1, 1, 1 is D65 with Y = 1; a channel's weight of D65 has the mean 1 over the luminance
/// curve.
ColorTable::ColorTable(const Responses& responses) : values_(3 + responses.count()), per_nm_(kNodes) {
    const Sums sums;
    for (int k = 0; k < kNodes; ++k) {
        const float nm = kMinWavelength + float(k);
        const Vec3d basis = rgb_basis(nm) * (d65(nm) / sums.white);
        const Spectrum curves = responses.count() ? responses.at(nm) : Spectrum(0.f);
        for (int part = 0; part < 3; ++part) {
            FilmColor& c = per_nm_[k][part];
            c = {float(basis[part] * cie_x(nm)), float(basis[part] * cie_y(nm)), float(basis[part] * cie_z(nm))};
            for (int i = 0; i < responses.count(); ++i) c[3 + i] = float(basis[part] * sums.curve) * curves[i];
        }
    }
}

std::vector<ColorTable::Parts> ColorTable::nodes(int count) const {
    std::vector<Parts> nodes(count);
    const float step_nm = (kMaxWavelength - kMinWavelength) / float(count - 1);
    for (int i = 0; i < (kNodes - 1) * kPerNm; ++i) {   // midpoints
        const float x = (float(i) + 0.5f) / kPerNm, place = x / step_nm;
        const int k = std::min(int(place), count - 2);
        const float high = (place - float(k)) / kPerNm, low = 1.f / kPerNm - high;
        for (int part = 0; part < 3; ++part) {
            add(nodes[k][part], kParts[part], kMinWavelength + x, low);
            add(nodes[k + 1][part], kParts[part], kMinWavelength + x, high);
        }
    }
    return nodes;
}

void ColorTable::add(FilmColor& color, Rgb light, float nm, float times) const {
    const float at = std::clamp(nm - kMinWavelength, 0.f, float(kNodes - 1));
    const int k = std::min(int(at), kNodes - 2);
    const float high = times * (at - float(k)), low = times - high;
    const Parts &a = per_nm_[k], &b = per_nm_[k + 1];
    for (std::size_t i = 0; i < color.size(); ++i) {
        const float from = a[0][i] * light.x + a[1][i] * light.y + a[2][i] * light.z;
        const float to = b[0][i] * light.x + b[1][i] * light.y + b[2][i] * light.z;
        color[i] += low * from + high * to;
    }
}

}  // namespace dg
