// exr_predictor.h -- predictor of OpenEXR's ZIP blocks. A block stores the even bytes followed by
// the odd bytes, each as the difference from its predecessor plus 128 (OpenEXR Technical
// Introduction, "ZIP").
#pragma once
#include <span>

#include "codec/bytes.h"

namespace dg {

/// Sums the differences and interleaves both halves. Throws Error unless both spans have the same
/// size; `pixels` must not overlap `packed`.
void undo_exr_predictor(Bytes packed, std::span<std::uint8_t> pixels);

}  // namespace dg
