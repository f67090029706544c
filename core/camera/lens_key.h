// lens_key.h -- what determines the set-up of an exact lens.
#pragma once
#include <string>

#include "camera/exact.h"

namespace dg {

/// Bytes of everything that determines the set-up: numbers of the prescription, iris, film and
/// settings. Lenses with equal keys draw the same bits.
std::string lens_key(const Prescription& lens, const ExactLensSettings& settings);

}  // namespace dg
