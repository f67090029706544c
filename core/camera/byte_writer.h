// byte_writer.h -- values as bytes that are equal if the values are. A struct is described by a list of
// its members: `describe(writer, value)`.
#pragma once
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "math/vec.h"

namespace dg {

/// Serializes its arguments to `bytes`.
class ByteWriter {
  public:
    template <typename... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    std::string bytes;

  private:
    template <typename T>
    void put(const T& v) {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
            bytes.append(reinterpret_cast<const char*>(&v), sizeof(T));
        else
            describe(*this, v);
    }
    void put(const std::string& s) { put(s.size()), bytes.append(s); }
    template <typename T>
    void put(const std::vector<T>& v) {
        put(v.size());
        for (const T& x : v) put(x);
    }
    template <typename T>
    void put(const std::optional<T>& v) {
        put(v.has_value());
        if (v) put(*v);
    }
    template <typename... T>
    void put(const std::variant<T...>& v) {
        put(v.index());
        std::visit([&](const auto& x) { put(x); }, v);
    }
    template <typename T, std::size_t N>
    void put(const T (&v)[N]) {
        for (const T& x : v) put(x);
    }
};

template <typename A>
void describe(A& a, const Vec2d& v) {
    a(v.x, v.y);
}
template <typename A>
void describe(A& a, const Vec3d& v) {
    a(v.x, v.y, v.z);
}

}  // namespace dg
