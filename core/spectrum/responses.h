// responses.h -- spectral responses of a sensor's channels.
#pragma once
#include <span>
#include <vector>

#include "spectrum/wavelengths.h"

namespace dg {

/// Up to four response curves, tabulated per nm from 380 to 780 and linear in between. A channel's
/// value is the integral of radiance times its curve; white is 1 if the curves are normalized to 1
/// for D65 of luminance 1.
class Responses {
  public:
    static constexpr int kMost = 4, kNodes = 401;
    Responses() = default;
    /// Curves one after the other, per nm. Throws Error unless there are 1 to 4 times 401 values,
    /// all finite and non-negative.
    explicit Responses(std::span<const double> curves);

    int count() const { return count_; }
    /// Values of the curves at a wavelength, one per lane.
    Spectrum at(float nm) const;
    /// Estimates of the channels from a sample, one per lane.
    Spectrum of(const Wavelengths& wavelengths, Spectrum radiance) const;

  private:
    int count_ = 0;
    std::vector<Spectrum> nodes_;
};

}  // namespace dg
