#include "develop/curve.h"

#include <string>

#include "math/error.h"

namespace dg {

std::vector<float> Curve::breakpoints() {
    std::vector<float> out{0};
    for (std::uint32_t i = kFirst; i <= kLast; ++i) out.push_back(std::bit_cast<float>(i << kFractionBits));
    return out;
}

Curve::Curve(std::vector<float> values) : values_(std::move(values)) {
    const std::size_t wanted = kLast - kFirst + 2;
    if (values_.size() != wanted)
        throw input_error("curve", "values", std::to_string(wanted), std::to_string(values_.size()));
    values_.push_back(values_.back());   // the last breakpoint starts a constant piece
}

}  // namespace dg
