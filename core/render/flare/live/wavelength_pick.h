// wavelength_pick.h -- samples wavelengths of single-color arrivals by the transmittance of the glass, to reduce color
// noise.
#pragma once
#include <algorithm>
#include <array>

#include "math/below_one.h"
#include "render/flare/live/live_source.h"

namespace dg {

class WavelengthPick {
  public:
    struct Picked {
        float place;    // see LiveSource::nm()
        float weight;   // factor on its light
    };

    /// `spectrum`: approximate transmittance at the source's nodes.
    explicit WavelengthPick(const std::array<float, LiveSource::kNodes>& spectrum) {
        std::array<float, kBins> light{};
        float sum = 0;
        for (int i = 0; i < kBins; ++i) sum += light[i] = passed(spectrum, LiveSource::nm((float(i) + 0.5f) / kBins));
        float before = 0;
        for (int i = 0; i < kBins; ++i) {
            const float of_light = sum > 0 ? light[i] / sum : 1.f / kBins;
            share_[i] = kEven / kBins + (1 - kEven) * of_light;
            end_[i] = before += share_[i];
        }
    }

    /// Samples a wavelength with u in [0, 1).
    Picked operator()(float u) const {
        int bin = 0;
        while (bin < kBins - 1 && u >= end_[bin]) ++bin;
        const float within = std::clamp((u - end_[bin]) / share_[bin] + 1, 0.f, kBelowOne);
        return {std::min((float(bin) + within) / kBins, kBelowOne), 1 / (kBins * share_[bin])};
    }

  private:
    static constexpr int kBins = 16;         // bins of equal brightness
    static constexpr float kEven = 0.5f;     // uniform share of the samples, as the spectrum is not exact

    static float passed(const std::array<float, LiveSource::kNodes>& spectrum, float nm) {
        const float place = std::clamp(LiveSource::node_of(nm), 0.f, float(LiveSource::kNodes - 1));
        const int k = std::min(int(place), LiveSource::kNodes - 2);
        return std::max(spectrum[k] + (place - float(k)) * (spectrum[k + 1] - spectrum[k]), 0.f);
    }

    std::array<float, kBins> share_{}, end_{};
};

}  // namespace dg
