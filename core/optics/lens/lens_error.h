// lens_error.h -- error for an unusable lens: an error code for programs, and the index of the
// faulty surface.
#pragma once
#include <string>
#include <utility>

#include "math/error.h"

namespace dg {

/// what() is the message followed by " [code]", for people; programs read the fields.
struct LensError : Error {
    LensError(std::string text, std::string error_code, int surface_index = -1)
        : Error(text + " [" + error_code + "]"),
          message(std::move(text)),
          code(std::move(error_code)),
          surface(surface_index) {}

    std::string message, code;
    int surface;  // index; -1: the whole lens
};

inline LensError lens_error(const std::string& code, int surface,
                            const std::string& where, const std::string& what,
                            const std::string& wanted, const std::string& got) {
    return {where + ": " + what + ": wanted " + wanted + ", got " + got, code, surface};
}

}  // namespace dg
