// responses.h -- what a sensor's channels make of light: weights over wavelengths.
#pragma once
#include <span>
#include <vector>

#include "spectrum/wavelengths.h"

namespace dg {

/// Up to four curves, tabulated at every nm from 380 to 780, linear between. A value of a channel is the
/// integral of radiance times its curve; curves of which D65 of luminance 1 makes 1 give white as 1.
class Responses {
  public:
    static constexpr int kMost = 4, kNodes = 401;
    Responses() = default;
    /// Curve by curve, per nm. Throws Error for another size than 1 .. 4 times 401, or values that are negative
    /// or not finite.
    explicit Responses(std::span<const double> curves);

    int count() const { return count_; }
    /// The curves at a wavelength, lane by lane.
    Spectrum at(float nm) const;
    /// One sample's estimate of the channels, lane by lane.
    Spectrum of(const Wavelengths& wavelengths, Spectrum radiance) const;

  private:
    int count_ = 0;
    std::vector<Spectrum> nodes_;
};

}  // namespace dg
