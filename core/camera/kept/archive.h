// archive.h -- binary serialization for caches on one machine (native byte order). A struct is
// described by a list of its members: `describe(archive, value)`.
#pragma once
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "math/hash.h"
#include "math/vec.h"

namespace dg {

/// 64-bit hash of the bytes; different seeds give independent hashes.
inline std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed) {
    std::uint64_t h = hash64(seed, bytes.size());
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
        h = hash64(h, word);
    }
    return h;
}

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

/// Deserializes into its arguments; `ok` turns false past the end or at implausible sizes.
class ArchiveReader {
  public:
    explicit ArchiveReader(std::string_view from) : rest(from) {}
    template <typename... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    std::string_view rest;
    bool ok = true;

  private:
    template <typename T>
    void get(T& v) {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
            copy(&v, sizeof(T));
        else
            describe(*this, v);
    }
    void get(std::string& s) {
        std::size_t size = 0;
        get(size);
        ok = ok && size <= rest.size();
        if (!ok) return;
        s.assign(rest.substr(0, size));
        rest.remove_prefix(size);
    }
    template <typename T>
    void get(std::vector<T>& v) {
        constexpr bool kNumbers = std::is_arithmetic_v<T>;
        std::size_t size = 0;
        get(size);
        ok = ok && size <= rest.size() / (kNumbers ? sizeof(T) : 1);  // elements of other types have at least one
                                                                      // byte
        if (!ok) return;
        v.resize(size);
        if constexpr (kNumbers)
            copy(v.data(), size * sizeof(T));
        else
            for (std::size_t i = 0; i < size && ok; ++i) get(v[i]);
    }
    template <typename T, std::size_t N>
    void get(T (&v)[N]) {
        static_assert(std::is_arithmetic_v<T>);
        copy(v, sizeof v);
    }
    void copy(void* to, std::size_t size) {
        ok = ok && rest.size() >= size;
        if (!ok || size == 0) return;
        std::memcpy(to, rest.data(), size);
        rest.remove_prefix(size);
    }
};

/// U for readers, const U for writers.
template <typename T, typename U>
concept Either = std::is_same_v<std::remove_const_t<T>, U>;

template <typename A, Either<Vec2d> T>
void describe(A& a, T& v) {
    a(v.x, v.y);
}
template <typename A, Either<Vec3d> T>
void describe(A& a, T& v) {
    a(v.x, v.y, v.z);
}

}  // namespace dg
