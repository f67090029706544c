#include "material/srgb.h"

#include <algorithm>
#include <cmath>

namespace dg {

Decode::Decode() {
    for (int i = 0; i < 256; ++i) {
        const double v = i / 255.0;
        srgb[i] = static_cast<float>(v <= 0.04045 ? v / 12.92
                                                  : std::pow((v + 0.055) / 1.055, 2.4));
        linear[i] = static_cast<float>(v);
    }
}
const Decode kDecode;

const SrgbSums& srgb_sums() {
    static const SrgbSums sums = [] {
        SrgbSums s;
        for (int i = 0; i < 256; ++i)
            s.light[i] = static_cast<std::uint16_t>(std::lround(kDecode.srgb[i] * SrgbSums::kOne));
        // Rounds in linear light rather than in code values, so that means preserve light.
        int code = 0;
        for (int sum = 0; sum <= 4 * SrgbSums::kOne; ++sum) {
            while (code < 255 && sum > 2 * (s.light[code] + s.light[code + 1])) ++code;
            s.code[sum] = static_cast<std::uint8_t>(code);
        }
        return s;
    }();
    return sums;
}

std::uint8_t srgb_code(float v) {
    const float sum = std::clamp(v, 0.f, 1.f) * (4 * SrgbSums::kOne);
    return srgb_sums().code[static_cast<int>(sum + 0.5f)];
}

}  // namespace dg
