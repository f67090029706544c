// aim_state.h -- cached set-up of an exact lens: serialization and cache key.
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

/// Hash, as 32 hexadecimal digits, of everything that determines the state: numbers of the
/// prescription, iris, film, settings, version of the method, SIMD target.
std::string aim_key(const Prescription& lens, const ExactLensSettings& settings);

std::string to_bytes(const AimState& state, const std::string& key);
/// Empty if the bytes are damaged or have another key.
std::optional<AimState> aim_from_bytes(const std::string& bytes, const std::string& key);

}  // namespace dg
