// lens_error.h -- a lens that cannot be used: a code that programs can ask for, and the
// surface.
#pragma once
#include <string>
#include <utility>

#include "math/error.h"

namespace dg {

/// The message ends in " [code]", by which Python knows it.
struct LensError : Error {
    LensError(const std::string& message, std::string error_code, int surface_index = -1)
        : Error(message + " [" + error_code + "]"),
          code(std::move(error_code)),
          surface(surface_index) {}

    std::string code;
    int surface;  // -1: the lens as a whole
};

inline LensError lens_error(const std::string& code, int surface,
                            const std::string& where, const std::string& what,
                            const std::string& wanted, const std::string& got) {
    return {where + ": " + what + ": wanted " + wanted + ", got " + got, code, surface};
}

}  // namespace dg
