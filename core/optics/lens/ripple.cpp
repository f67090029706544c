#include "optics/lens/ripple.h"

#include <cmath>

#include "math/hash.h"
#include "math/vec.h"

namespace dg {

// Waves of equal amplitude a at frequencies spread over an octave: the sum of N has the root mean
// square a sqrt(N / 2).
RippleSlope::RippleSlope(const Ripple& ripple, double semi_diameter) {
    if (!(ripple.rms_nm > 0 && ripple.period_um > 0)) return;
    constexpr int kWaves = 8, kStepsPerWave = 16;
    const double period = 1e-3 * ripple.period_um, reach = std::min(semi_diameter, 100.0);
    const double height = 1e-6 * ripple.rms_nm * std::sqrt(2.0 / kWaves);
    steps_per_mm = kStepsPerWave * std::sqrt(2.0) / period;
    const std::size_t count = std::size_t(reach * steps_per_mm) + 3;
    slope.resize(count);
    double frequency[kWaves], phase[kWaves];
    for (int k = 0; k < kWaves; ++k) {
        const double place = (k + hash_uniform(ripple.seed, 2 * k)) / kWaves - 0.5;
        frequency[k] = 2 * kPiD / period * std::exp2(place);
        phase[k] = 2 * kPiD * hash_uniform(ripple.seed, 2 * k + 1);
    }
    for (std::size_t i = 0; i < count; ++i) {
        double sum = 0;
        for (int k = 0; k < kWaves; ++k)
            sum += frequency[k] * std::cos(frequency[k] * double(i) / steps_per_mm + phase[k]);
        slope[i] = float(height * sum);
    }
}

}  // namespace dg
