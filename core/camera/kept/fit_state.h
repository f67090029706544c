// fit_state.h -- a fitted lens as bytes to keep.
#pragma once
#include <optional>
#include <string>

#include "optics/expansion/lens_fit.h"

namespace dg {

std::string to_bytes(const LensFit& fit);
/// Nothing if they are damaged.
std::optional<LensFit> fit_from_bytes(const std::string& bytes);

}  // namespace dg
