// input.h -- the fuzzer's bytes as numbers: ordinary ones, and often the awkward ones.
#pragma once
#include <cstdint>
#include <cstring>
#include <limits>

#include "math/vec.h"

namespace dg {

/// Hands out bytes; behind their end come zeros.
class FuzzInput {
  public:
    FuzzInput(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    bool empty() const { return left_ == 0; }
    std::size_t left() const { return left_; }
    const std::uint8_t* rest() const { return data_; }

    template <typename T>
    T raw() {
        T value{};
        const std::size_t n = left_ < sizeof(T) ? left_ : sizeof(T);
        if (n > 0) std::memcpy(&value, data_, n);
        data_ += n;
        left_ -= n;
        return value;
    }
    /// In 0 .. n - 1.
    int below(int n) { return raw<std::uint8_t>() % n; }
    bool flag() { return below(2) == 1; }

    /// Any float: one byte of an eighth, two of a plain number, or four of any bits.
    float number() {
        static constexpr float kAwkward[] = {
            0.f,    -0.f,   1.f,    -1.f,  1e-42f, 1e-30f, 1e-10f,
            1e10f,  1e17f,  1e30f,  3e38f, 0.5f,   std::numeric_limits<float>::infinity(),
            std::numeric_limits<float>::quiet_NaN(), 1e-4f, 1000.f};
        const std::uint8_t kind = raw<std::uint8_t>();
        if (kind < 160) return (kind - 80) / 16.f;
        if (kind < 240) return raw<std::int16_t>() / 1024.f;
        if (kind < 250) return kAwkward[below(16)];
        return raw<float>();
    }
    /// In 0 .. 1, unless the bytes ask for an awkward number.
    float factor() {
        const std::uint8_t kind = raw<std::uint8_t>();
        return kind < 250 ? kind / 249.f : number();
    }
    Vec3f vec3() {
        const float x = number(), y = number();
        return {x, y, number()};
    }

  private:
    const std::uint8_t* data_;
    std::size_t left_;
};

}  // namespace dg
