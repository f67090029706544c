#include "medium/segment.h"

#include <algorithm>
#include <cmath>

#include "math/below_one.h"

namespace dg {
namespace {

constexpr float kLeastDensity = 1e-30f;   // the inverse of smaller densities overflows

}  // namespace

void Segment::find_collisions() {
    float sum = 0;
    for (int k = 0; k < kWavelengths; ++k) {
        if (rate_[k] > 0) met_.set(k, -std::expm1(-rate_[k] * length_));
        if (met_[k] > 0) sum += lanes_[k];
    }
    for (int k = 0; k < kWavelengths; ++k)
        if (met_[k] > 0 && sum > 0) colliding_.set(k, float(kWavelengths) * lanes_[k] / (sum * met_[k]));
}

/// Chooses a wavelength by its share, and rescales u to be uniform again. Grey media need no choice.
int Segment::choose(Spectrum shares, float& u) const {
    if (rate_.min() == rate_.max()) return 0;
    float rest = u * (shares[0] + shares[1] + shares[2] + shares[3]);
    int chosen = 0;
    for (int k = 0; k < kWavelengths; ++k) {
        if (!(shares[k] > 0)) continue;
        chosen = k;
        if (rest < shares[k]) break;
        rest -= shares[k];
    }
    if (shares[chosen] > 0) u = std::clamp(rest / shares[chosen], 0.f, kBelowOne);
    return chosen;
}

float Segment::before_end(int k, float u) const {
    return std::min(-std::log1p(-u * met_[k]) / rate_[k], length_);
}

float Segment::free_collision(float u) const {
    const int k = choose(lanes_ * met_, u);
    return before_end(k, u);
}

float Segment::collision(float u) const {
    const int k = choose(colliding_ * met_, u);
    return before_end(k, u);
}

Spectrum Segment::emitted() const {
    Spectrum sum{0.f};
    for (int k = 0; k < kWavelengths; ++k) {
        const float rate = medium_.extinction[k];
        const float effective_length = rate > 0 ? -std::expm1(-rate * length_) / rate : length_;
        if (medium_.emission[k] > 0) sum.set(k, medium_.emission[k] * effective_length);
    }
    return sum;
}

Segment::Onward Segment::onward(Spectrum value, Spectrum density) const {
    const Spectrum lanes = lanes_ * density;
    const float mean = lanes.average();
    if (!(mean > kLeastDensity)) return {0.f, lanes_};
    return {value / mean, lanes / mean};
}

}  // namespace dg
