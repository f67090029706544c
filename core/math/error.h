// error.h -- dg::Error for bad input (what, where, wanted, got); DG_CHECK for internal invariants.
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

namespace dg {

/// Unusable input. The message is a sentence that the user can act on; in Python,
/// daguerre._core.Error.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// "where: what: wanted ..., got ..."
inline Error input_error(const std::string& where, const std::string& what,
                         const std::string& wanted, const std::string& got) {
    return Error(where + ": " + what + ": wanted " + wanted + ", got " + got);
}

template <typename A, typename B>
[[noreturn]] void check_failed(const char* file, int line, const char* expr, const A& a, const B& b) {
    std::ostringstream s;
    s << file << ":" << line << ": impossible state: " << expr << " (" << a << " against " << b << ")";
    throw std::logic_error(s.str());
}

}  // namespace dg

#define DG_CHECK(a, op, b)                                                         \
    do {                                                                           \
        if (!((a)op(b))) ::dg::check_failed(__FILE__, __LINE__, #a " " #op " " #b, a, b); \
    } while (0)
