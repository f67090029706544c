// bytes.h -- bounds-checked reader of packed bytes.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "math/error.h"

namespace dg {

using Bytes = std::span<const std::uint8_t>;

/// Reads bytes in order; throws Error past the end.
class ByteReader {
  public:
    ByteReader(Bytes bytes, const char* what) : bytes_(bytes), what_(what) {}

    Bytes take(std::size_t count) {
        if (count > left())
            throw input_error(what_, "truncated", std::to_string(count) + " more bytes",
                              std::to_string(left()));
        const Bytes taken = bytes_.subspan(at_, count);
        at_ += count;
        return taken;
    }
    std::uint8_t byte() { return take(1)[0]; }

    /// LEB128 of 1 to 5 bytes; bits beyond 32 are ignored.
    std::uint32_t varint() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const std::uint8_t next = byte();
            value |= std::uint32_t(next & 0x7f) << shift;
            if (next < 0x80) return value;
        }
        throw input_error(what_, "number", "at most 5 bytes", "more");
    }

    std::size_t left() const { return bytes_.size() - at_; }

    /// Throws Error unless all bytes were read.
    void finish() const {
        if (left() != 0)
            throw input_error(what_, "length", "all bytes used",
                              std::to_string(left()) + " left over");
    }

  private:
    Bytes bytes_;
    const char* what_;
    std::size_t at_ = 0;
};

}  // namespace dg
