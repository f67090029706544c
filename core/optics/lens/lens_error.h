// lens_error.h -- a lens that cannot be used: a code that programs can ask for, and the
// surface.
#pragma once
#include <string>
#include <utility>

#include "math/error.h"

namespace dg {

/// what() is the message with " [code]" behind it, for people; programs read the fields.
struct LensError : Error {
    LensError(std::string text, std::string error_code, int surface_index = -1)
        : Error(text + " [" + error_code + "]"),
          message(std::move(text)),
          code(std::move(error_code)),
          surface(surface_index) {}

    std::string message, code;
    int surface;  // -1: the lens as a whole
};

inline LensError lens_error(const std::string& code, int surface,
                            const std::string& where, const std::string& what,
                            const std::string& wanted, const std::string& got) {
    return {where + ": " + what + ": wanted " + wanted + ", got " + got, code, surface};
}

}  // namespace dg
