// meshopt_indices.cpp -- modes TRIANGLES and INDICES: short codes for recent indices.
#include <array>

#include "codec/meshopt.h"

namespace dg {
namespace {

/// Ring buffer of the last 16 values; reading a slot that was never pushed is an Error.
template <typename T>
class Fifo {
  public:
    void push(const T& value) { slots_[pushed_++ % 16] = value; }
    /// Value pushed `ago` pushes before the last.
    const T& operator[](unsigned ago) const {
        if (ago >= pushed_)
            throw input_error(
                "meshopt triangles", "code", "an earlier vertex or edge",
                "entry " + std::to_string(ago) + " of " + std::to_string(pushed_));
        return slots_[(pushed_ - 1 - ago) % 16];
    }

  private:
    std::array<T, 16> slots_{};
    std::size_t pushed_ = 0;
};

std::uint32_t unzigzag(std::uint32_t v) {
    return (v >> 1) ^ (0u - (v & 1));
}

/// Writes indices as 2 or 4 little-endian bytes.
class IndexWriter {
  public:
    IndexWriter(std::size_t count, std::size_t stride) : stride_(stride) {
        out_.reserve(count * stride);
    }
    void put(std::uint32_t index) {
        for (std::size_t b = 0; b < stride_; ++b)
            out_.push_back(std::uint8_t(index >> (8 * b)));
    }
    std::vector<std::uint8_t> take() { return std::move(out_); }

  private:
    std::size_t stride_;
    std::vector<std::uint8_t> out_;
};

struct Edge {
    std::uint32_t a, b;
};
struct Triangle {
    std::uint32_t a, b, c;
};

/// State of the triangle decoder, named as in the specification.
struct Triangles {
    ByteReader data;
    Bytes codeaux;
    std::uint32_t next = 0, last = 0;
    Fifo<Edge> edges;
    Fifo<std::uint32_t> vertices;

    std::uint32_t explicit_index() { return last += unzigzag(data.varint()); }

    /// Code 0xXY with X < 15: a recent edge and a third vertex.
    Triangle on_edge(std::uint8_t code) {
        const Edge edge = edges[code >> 4];
        const unsigned y = code & 15;
        std::uint32_t c;
        if (y == 0)
            c = next++;
        else if (y < 13)
            c = vertices[y];
        else if (y == 13)
            c = --last;
        else if (y == 14)
            c = ++last;
        else
            c = explicit_index();
        edges.push({c, edge.b});
        edges.push({edge.a, c});
        if (y == 0 || y >= 13) vertices.push(c);
        return {edge.a, edge.b, c};
    }

    /// Vertex by a nibble of the table: 0 next vertex, 15 explicit index, otherwise a recent
    /// vertex.
    std::uint32_t vertex(unsigned nibble) {
        if (nibble == 0) return next++;
        return nibble == 15 ? explicit_index() : vertices[nibble - 1];
    }

    /// Code 0xfY: three vertices, each new, recent or explicit.
    Triangle on_its_own(std::uint8_t code) {
        const bool free = code >= 0xfe;
        const std::uint8_t table = free ? data.byte() : codeaux[code & 15];
        if (free && table == 0) next = 0;
        const std::uint32_t a = code == 0xff ? explicit_index() : next++;
        const std::uint32_t b = vertex(table >> 4);
        const std::uint32_t c = vertex(table & 15);
        edges.push({b, a});
        edges.push({c, b});
        edges.push({a, c});
        const auto is_new = [](unsigned nibble) { return nibble == 0 || nibble == 15; };
        vertices.push(a);
        if (is_new(table >> 4)) vertices.push(b);
        if (is_new(table & 15)) vertices.push(c);
        return {a, b, c};
    }
};

/// Bytes between the header byte and a tail of fixed size; checks that there are at least `least`.
Bytes body(Bytes packed, const char* what, int header, std::size_t tail,
           std::size_t least) {
    if (packed.size() < 1 + tail || packed.size() - 1 - tail < least)
        throw input_error(what, "truncated",
                          "at least " + std::to_string(1 + tail + least) + " bytes",
                          std::to_string(packed.size()));
    if (packed[0] != header)
        throw input_error(what, "header", std::to_string(header),
                          std::to_string(packed[0]));
    return packed.subspan(1, packed.size() - 1 - tail);
}

void check_stride(std::size_t stride, const char* what) {
    if (stride != 2 && stride != 4)
        throw input_error(what, "stride", "2 or 4", std::to_string(stride));
}

}  // namespace

std::vector<std::uint8_t> unpack_triangles(Bytes packed, std::size_t count,
                                           std::size_t stride) {
    constexpr const char* kWhat = "meshopt triangles";
    check_stride(stride, kWhat);
    if (count % 3 != 0)
        throw input_error(kWhat, "count", "a multiple of 3", std::to_string(count));
    const Bytes inner = body(packed, kWhat, 0xe1, 16, count / 3);
    const Bytes codeaux = packed.last(16);
    for (const std::uint8_t pair : codeaux)
        if ((pair >> 4) == 15 || (pair & 15) == 15)
            throw input_error(kWhat, "table", "no nibble 15", std::to_string(pair));
    IndexWriter out(count, stride);
    Triangles state{ByteReader(inner.subspan(count / 3), kWhat), codeaux, 0, 0, {}, {}};
    for (const std::uint8_t code : inner.first(count / 3)) {
        const Triangle t = code < 0xf0 ? state.on_edge(code) : state.on_its_own(code);
        out.put(t.a);
        out.put(t.b);
        out.put(t.c);
    }
    state.data.finish();
    return out.take();
}

std::vector<std::uint8_t> unpack_indices(Bytes packed, std::size_t count,
                                         std::size_t stride) {
    constexpr const char* kWhat = "meshopt indices";
    check_stride(stride, kWhat);
    ByteReader in(body(packed, kWhat, 0xd1, 4, count), kWhat);
    IndexWriter out(count, stride);
    std::array<std::uint32_t, 2> last{};
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t v = in.varint();
        out.put(last[v & 1] += unzigzag(v >> 1));
    }
    in.finish();
    return out.take();
}

}  // namespace dg
