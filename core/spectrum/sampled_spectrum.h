// sampled_spectrum.h -- spectra measured by wavelength.
#pragma once
#include <array>
#include <memory>
#include <span>

#include "spectrum/wavelengths.h"

namespace dg {

/// Linear between samples, constant beyond the ends. Resampled to every nm of the visible range.
class SampledSpectrum {
  public:
    /// Throws Error for wavelengths (nm) that do not ascend, a different number of values, or
    /// negative or non-finite values.
    SampledSpectrum(std::span<const double> nm, std::span<const double> values);

    float at(float nm) const;
    Spectrum at(Spectrum nm) const { return {at(nm[0]), at(nm[1]), at(nm[2]), at(nm[3])}; }
    float least() const;
    float most() const;
    /// Colour under D65.
    Rgb rgb() const;
    friend bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;

  private:
    static constexpr int kNodes = 401;
    std::array<float, kNodes> nodes_;
};

/// Shared spectrum, or none. Compares by value.
class SharedSpectrum {
  public:
    SharedSpectrum() = default;
    SharedSpectrum(std::shared_ptr<const SampledSpectrum> spectrum) : spectrum_(std::move(spectrum)) {}  // NOLINT
    explicit operator bool() const { return spectrum_ != nullptr; }
    const SampledSpectrum* operator->() const { return spectrum_.get(); }
    friend bool operator==(const SharedSpectrum& a, const SharedSpectrum& b) {
        return a.spectrum_ == b.spectrum_ || (a && b && *a.spectrum_ == *b.spectrum_);
    }

  private:
    std::shared_ptr<const SampledSpectrum> spectrum_;
};

/// Spectral value: a colour to be upsampled, or a measured spectrum.
struct SpectralColor {
    Rgb rgb{0, 0, 0};
    SharedSpectrum sampled;

    SpectralColor() = default;
    SpectralColor(Rgb c) : rgb(c) {}  // NOLINT: colours convert implicitly
    SpectralColor(float r, float g, float b) : rgb{r, g, b} {}
    SpectralColor(std::shared_ptr<const SampledSpectrum> s) : sampled(std::move(s)) {}  // NOLINT

    Spectrum at(const Wavelengths& w) const { return sampled ? sampled->at(w.nm) : w.reflectance(rgb); }
    Rgb color() const { return sampled ? sampled->rgb() : rgb; }
    bool is_black() const { return sampled ? !(sampled->most() > 0) : rgb == Rgb{0, 0, 0}; }
};

}  // namespace dg
