// fit_state.h -- serialization of a fitted lens.
#pragma once
#include <optional>
#include <string>

#include "optics/expansion/lens_fit.h"

namespace dg {

std::string to_bytes(const LensFit& fit);
/// Empty if the bytes are damaged.
std::optional<LensFit> fit_from_bytes(const std::string& bytes);

}  // namespace dg
