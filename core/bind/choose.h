// choose.h -- converts names from Python to enum values.
#pragma once
#include <initializer_list>
#include <string>
#include <utility>

#include "math/error.h"

namespace dg::bind {

template <typename Enum>
Enum choose(const std::string& what, const std::string& name,
            std::initializer_list<std::pair<const char*, Enum>> known,
            const char* where = "texture") {
    std::string names;
    for (const auto& [key, value] : known) {
        if (name == key) return value;
        names += (names.empty() ? "" : ", ") + std::string(key);
    }
    throw input_error(where, what, names, name);
}

}  // namespace dg::bind
