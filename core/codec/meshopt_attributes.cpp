// meshopt_attributes.cpp -- mode ATTRIBUTES: deltas between elements, stored per byte plane.
#include <algorithm>
#include <array>
#include <bit>

#include "codec/meshopt.h"

namespace dg {
namespace {

constexpr const char* kWhat = "meshopt attributes";
constexpr std::size_t kGroup = 16, kMaxBlock = 256;
using Plane = std::array<std::uint8_t, kMaxBlock>;

/// Encoding of a byte plane: delta width in bits for each of the four header values of a group, or
/// no groups.
struct Control {
    enum Kind { kGroups, kZero, kLiteral } kind;
    std::array<int, 4> bits;
};
constexpr Control kVersion0{Control::kGroups, {0, 2, 4, 8}};
constexpr std::array<Control, 4> kControls{{{Control::kGroups, {0, 1, 2, 4}},
                                            {Control::kGroups, {1, 2, 4, 8}},
                                            {Control::kZero, {}},
                                            {Control::kLiteral, {}}}};

/// Decodes 16 deltas of `bits` each; a delta with all bits set is replaced by a literal byte after
/// the group.
void unpack_group(ByteReader& in, int bits, std::uint8_t* out) {
    if (bits == 0) {
        std::fill_n(out, kGroup, std::uint8_t(0));
        return;
    }
    const Bytes packed = in.take(kGroup * bits / 8);
    if (bits == 8) {
        std::copy(packed.begin(), packed.end(), out);
        return;
    }
    const int sentinel = (1 << bits) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
        const int bit = int(i) * bits, place = bit % 8;
        // One-bit deltas start at the lowest bit, wider deltas at the highest.
        const int shift = bits == 1 ? place : 8 - bits - place;
        const int value = (packed[bit / 8] >> shift) & sentinel;
        out[i] = value == sentinel ? in.byte() : std::uint8_t(value);
    }
}

void unpack_plane(ByteReader& in, const Control& control, std::size_t count,
                  Plane& plane) {
    if (control.kind == Control::kZero) {
        plane.fill(0);
        return;
    }
    if (control.kind == Control::kLiteral) {
        const Bytes bytes = in.take(count);
        std::copy(bytes.begin(), bytes.end(), plane.begin());
        return;
    }
    const std::size_t groups = (count + kGroup - 1) / kGroup;
    const Bytes header = in.take((groups + 3) / 4);
    for (std::size_t g = 0; g < groups; ++g)
        unpack_group(in, control.bits[(header[g / 4] >> (g % 4 * 2)) & 3],
                     &plane[g * kGroup]);
}

template <typename T>
T unzigzag(T v) {
    return T((v >> 1) ^ T(-T(v & 1)));
}

/// Accumulates deltas of type T; `planes` are the bytes of a channel, lowest byte first.
template <typename T>
void add_deltas(const Plane* planes, std::size_t count, std::size_t stride,
                std::uint8_t* last, std::uint8_t* out) {
    for (std::size_t k = 0; k < 4; k += sizeof(T)) {
        T value = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b)
            value = T(value | T(T(last[k + b]) << (8 * b)));
        for (std::size_t i = 0; i < count; ++i) {
            T delta = 0;
            for (std::size_t b = 0; b < sizeof(T); ++b)
                delta = T(delta | T(T(planes[k + b][i]) << (8 * b)));
            value = T(value + unzigzag(delta));
            for (std::size_t b = 0; b < sizeof(T); ++b)
                out[i * stride + k + b] = std::uint8_t(value >> (8 * b));
        }
        for (std::size_t b = 0; b < sizeof(T); ++b)
            last[k + b] = std::uint8_t(value >> (8 * b));
    }
}

/// Deltas combined by XOR, stored rotated left by `turn` bits.
void xor_deltas(const Plane* planes, int turn, std::size_t count, std::size_t stride,
                std::uint8_t* last, std::uint8_t* out) {
    std::uint32_t value = 0;
    for (int b = 0; b < 4; ++b) value |= std::uint32_t(last[b]) << (8 * b);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t delta = 0;
        for (int b = 0; b < 4; ++b) delta |= std::uint32_t(planes[b][i]) << (8 * b);
        value ^= std::rotr(delta, turn);
        for (int b = 0; b < 4; ++b) out[i * stride + b] = std::uint8_t(value >> (8 * b));
    }
    for (int b = 0; b < 4; ++b) last[b] = std::uint8_t(value >> (8 * b));
}

void decode_channel(int mode, const Plane* planes, std::size_t count, std::size_t stride,
                    std::uint8_t* last, std::uint8_t* out) {
    switch (mode & 15) {
        case 0:
            return add_deltas<std::uint8_t>(planes, count, stride, last, out);
        case 1:
            return add_deltas<std::uint16_t>(planes, count, stride, last, out);
        default:
            return xor_deltas(planes, mode >> 4, count, stride, last, out);
    }
}

/// Sections of a stream before its blocks are decoded.
struct Layout {
    int version;
    std::size_t block;  // elements
    Bytes body, baseline, modes;
};

Layout lay_out(Bytes packed, std::size_t count, std::size_t stride) {
    if (stride < 4 || stride > 256 || stride % 4 != 0)
        throw input_error(kWhat, "stride", "a multiple of 4 in 4 .. 256",
                          std::to_string(stride));
    if (count > (std::size_t(1) << 48))
        throw input_error(kWhat, "count", "at most 2^48", std::to_string(count));
    const int header = packed.empty() ? -1 : packed[0];
    if (header != 0xa0 && header != 0xa1)
        throw input_error(kWhat, "header", "160 or 161", std::to_string(header));
    const int version = header & 1;
    const std::size_t block = std::min((8192 / stride) & ~(kGroup - 1), kMaxBlock);
    const std::size_t base = stride + (version ? stride / 4 : 0);
    const std::size_t tail = std::max<std::size_t>(base, version ? 24 : 32);
    // Minimal size: 2 bits per group and position in version 0, 2 bits per block and position in
    // version 1.
    const std::size_t blocks = count / block + (count % block != 0);
    const std::size_t least =
        version ? blocks * (stride / 4) : count / (4 * kGroup) * stride;
    if (packed.size() < 1 + tail || (packed.size() - 1 - tail) < least)
        throw input_error(kWhat, "truncated",
                          "at least " + std::to_string(1 + tail + least) + " bytes",
                          std::to_string(packed.size()));
    const Bytes end = packed.last(base);
    return {version, block, packed.subspan(1, packed.size() - 1 - tail),
            end.first(stride), end.subspan(stride)};
}

}  // namespace

std::vector<std::uint8_t> unpack_attributes(Bytes packed, std::size_t count,
                                            std::size_t stride) {
    const Layout layout = lay_out(packed, count, stride);
    for (const std::uint8_t mode : layout.modes)
        if ((mode & 15) > 2 || ((mode & 15) < 2 && mode > 15))
            throw input_error(kWhat, "channel mode", "0, 1 or 2 + 16 * rotation",
                              std::to_string(mode));
    std::vector<std::uint8_t> out(count * stride);
    std::vector<std::uint8_t> last(layout.baseline.begin(), layout.baseline.end());
    std::array<Plane, 4> planes;
    ByteReader in(layout.body, kWhat);
    for (std::size_t first = 0; first < count; first += layout.block) {
        const std::size_t size = std::min(layout.block, count - first);
        const Bytes controls = in.take(layout.version ? stride / 4 : 0);
        for (std::size_t channel = 0; channel < stride / 4; ++channel) {
            for (int b = 0; b < 4; ++b) {
                const Control& control =
                    layout.version ? kControls[(controls[channel] >> (2 * b)) & 3]
                                   : kVersion0;
                unpack_plane(in, control, size, planes[b]);
            }
            decode_channel(layout.version ? layout.modes[channel] : 0, planes.data(),
                           size, stride, &last[channel * 4],
                           &out[first * stride + channel * 4]);
        }
    }
    in.finish();
    return out;
}

}  // namespace dg
