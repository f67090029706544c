#include "spectrum/responses.h"

#include <string>

#include "math/error.h"

namespace dg {

Responses::Responses(std::span<const double> curves)
    : count_(int(curves.size() / kNodes)), nodes_(kNodes) {
    if (curves.size() % kNodes != 0 || count_ < 1 || count_ > kMost)
        throw input_error("responses", "values", "1 to 4 curves of 401 each", std::to_string(curves.size()));
    for (int c = 0; c < count_; ++c)
        for (int i = 0; i < kNodes; ++i) {
            const double value = curves[std::size_t(c) * kNodes + i];
            if (!(value >= 0 && value < 1e6))
                throw input_error("responses", "channel " + std::to_string(c), "values from 0 to 1e6 per nm",
                                  std::to_string(value) + " at " + std::to_string(380 + i) + " nm");
            nodes_[i].set(c, float(value));
        }
}

Spectrum Responses::at(float nm) const {
    const float x = nm - kMinWavelength;
    const int i = std::clamp(int(x), 0, kNodes - 2);
    return lerp(x - float(i), nodes_[i], nodes_[i + 1]);
}

Spectrum Responses::of(const Wavelengths& wavelengths, Spectrum radiance) const {
    const Spectrum light = radiance * wavelengths.measure();
    Spectrum sum;
    for (int k = 0; k < kWavelengths; ++k) sum += at(wavelengths.nm[k]) * light[k];
    return sum;
}

}  // namespace dg
