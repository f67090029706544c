#include "spectrum/sampled_spectrum.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/error.h"

namespace dg {
namespace {

void check(std::span<const double> nm, std::span<const double> values) {
    if (nm.empty() || nm.size() != values.size())
        throw input_error("spectrum", "values", "one for each wavelength, at least one",
                          std::to_string(values.size()) + " for " + std::to_string(nm.size()));
    for (std::size_t i = 0; i < nm.size(); ++i) {
        if (!std::isfinite(nm[i]) || (i > 0 && !(nm[i] > nm[i - 1])))
            throw input_error("spectrum", "wavelengths", "finite numbers that increase", std::to_string(nm[i]) + " nm");
        if (!(values[i] >= 0) || !std::isfinite(static_cast<float>(values[i])))
            throw input_error("spectrum", "values", "finite numbers of at least 0", std::to_string(values[i]));
    }
}

double interpolated(std::span<const double> nm, std::span<const double> values, double at) {
    const std::size_t right = std::size_t(std::ranges::upper_bound(nm, at) - nm.begin());
    if (right == 0) return values.front();
    if (right == nm.size()) return values.back();
    const double share = (at - nm[right - 1]) / (nm[right] - nm[right - 1]);
    return values[right - 1] + share * (values[right] - values[right - 1]);
}

}  // namespace

SampledSpectrum::SampledSpectrum(std::span<const double> nm, std::span<const double> values) {
    check(nm, values);
    for (int i = 0; i < kNodes; ++i)
        nodes_[std::size_t(i)] = static_cast<float>(interpolated(nm, values, double(kMinWavelength) + i));
}

float SampledSpectrum::at(float nm) const {
    const float x = std::clamp(nm - kMinWavelength, 0.f, float(kNodes - 1));
    const int i = std::min(static_cast<int>(x), kNodes - 2);
    const float low = nodes_[std::size_t(i)], high = nodes_[std::size_t(i) + 1];
    return low + (x - static_cast<float>(i)) * (high - low);
}

float SampledSpectrum::least() const { return *std::ranges::min_element(nodes_); }
float SampledSpectrum::most() const { return *std::ranges::max_element(nodes_); }

Rgb SampledSpectrum::rgb() const {
    Vec3d sum{}, white{};
    for (int i = 0; i < kNodes; ++i) {
        const double nm = double(kMinWavelength) + i, light = d65(nm), value = nodes_[std::size_t(i)];
        const Vec3d matched = Vec3d{cie_x(nm), cie_y(nm), cie_z(nm)} * light;
        sum += matched * value;
        white += matched;
    }
    const Vec3f of_white = xyz_from_rgb({1, 1, 1});
    return rgb_from_xyz({float(sum.x / white.x) * of_white.x, float(sum.y / white.y) * of_white.y,
                         float(sum.z / white.z) * of_white.z});
}

}  // namespace dg
