// exr_predictor.h -- inflated bytes of an OpenEXR block as its pixels. A block keeps the even bytes first, then the
// odd ones, each as its difference to the one before, plus 128 (OpenEXR Technical Introduction, "ZIP").
#pragma once
#include <span>

#include "codec/bytes.h"

namespace dg {

/// Adds the differences up and puts both halves together again. Error unless both have as many bytes; `pixels` may
/// not overlap `packed`.
void undo_exr_predictor(Bytes packed, std::span<std::uint8_t> pixels);

}  // namespace dg
