// emitter_check.h -- checks shared by the kinds of light, and the brightness for choosing lights.
#pragma once
#include <sstream>
#include <string>

#include "math/error.h"
#include "spectrum/wavelengths.h"

namespace dg {

inline std::string vector_text(Vec3f v) {
    std::ostringstream text;
    text << "(" << v.x << ", " << v.y << ", " << v.z << ")";
    return text.str();
}

inline bool is_finite(Vec3f v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline void check_finite(const std::string& where, const char* what, Vec3f v) {
    if (!is_finite(v)) throw input_error(where, what, "finite numbers", vector_text(v));
}
inline void check_color(const std::string& where, const char* what, Rgb c) {
    if (is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) return;
    throw input_error(where, what, "finite values >= 0", vector_text(c));
}
inline void check_unit(const std::string& where, const char* what, Vec3f v) {
    if (is_finite(v) && std::abs(length(v) - 1) < 1e-3f) return;
    throw input_error(where, what, "a unit vector", vector_text(v));
}
inline void check_positive(const std::string& where, const char* what, float v) {
    if (!(v > 0)) throw input_error(where, what, "a number > 0", std::to_string(v));
}

/// Mixes luminance with the mean of the channels: a pure blue lamp has a low luminance, but causes as much noise in the
/// picture's blue channel.
inline float selection_weight(Rgb c) {
    return 0.5f * (luminance(c) + (c.x + c.y + c.z) / 3);
}

}  // namespace dg
