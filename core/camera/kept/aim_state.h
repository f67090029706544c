// aim_state.h -- what the set-up of an exact lens finds out, as bytes to keep, and under which name.
#pragma once
#include <optional>
#include <string>

#include "camera/exact.h"

namespace dg {

struct AimState {
    Aim aim;
    double h0 = 0, transmittance = 0;
    std::string fit{};  // of a fitted lens, see fit_state.h
};

/// 32 hexadecimal digits that differ as soon as anything differs of which the state depends: numbers of
/// the prescription, iris, film, settings, version of the method, SIMD target.
std::string aim_key(const Prescription& lens, const ExactLensSettings& settings);

std::string to_bytes(const AimState& state, const std::string& key);
/// Nothing if they are damaged or belong to another key.
std::optional<AimState> aim_from_bytes(const std::string& bytes, const std::string& key);

}  // namespace dg
