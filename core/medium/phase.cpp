#include "medium/phase.h"

#include "math/error.h"

namespace dg {

Phase::Phase(std::span<const PhaseLobe> lobes) : count_(lobes.size()) {
    if (lobes.empty() || lobes.size() > kMost)
        throw input_error("medium", "lobes", "1 to " + std::to_string(kMost), std::to_string(lobes.size()));
    float sum = 0;
    for (const PhaseLobe& lobe : lobes) {
        if (!(std::abs(lobe.mean_cosine) < 1))
            throw input_error("medium", "lobes: g", "between -1 and 1", std::to_string(lobe.mean_cosine));
        if (!(lobe.share >= 0))
            throw input_error("medium", "lobes: weight", "at least 0", std::to_string(lobe.share));
        sum += lobe.share;
    }
    if (!(sum > 0) || !std::isfinite(sum))
        throw input_error("medium", "lobes: weights", "a finite sum above 0", std::to_string(sum));
    for (std::size_t i = 0; i < count_; ++i) lobes_[i] = {lobes[i].mean_cosine, lobes[i].share / sum};
    angles_ = PhaseAngles([this](float turn) { return of_turn(turn); });
}

float Phase::of_turn(float turn) const {
    float sum = 0;
    for (const PhaseLobe& lobe : lobes()) sum += lobe.share * lobe.value(turn);
    return sum;
}

/// The scattering angle is between -wo and wi. 1 - c is computed from the difference of the vectors, since the dot
/// product of nearly equal directions loses precision.
float Phase::value(Vec3f wo, Vec3f wi) const {
    return of_turn(0.5f * length_squared(wo + wi));
}

Vec3f Phase::sample(Vec3f wo, float u_lobe, Vec2f u) const {
    std::size_t i = 0;
    while (i + 1 < count_ && u_lobe >= lobes_[i].share) u_lobe -= lobes_[i++].share;
    const float turn = lobes_[i].sample(u.x), across = std::sqrt(turn * (2 - turn)), phi = 2 * kPi * u.y;
    return Frame::from_normal(-wo).to_world({across * std::cos(phi), across * std::sin(phi), 1 - turn});
}

}  // namespace dg
