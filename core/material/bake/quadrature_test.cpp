// quadrature_test.cpp -- the baked tables against the quadrature.
#include "material/bake/quadrature.h"

#include <doctest/doctest.h>

#include <cstring>

namespace dg {
namespace {

/// Number of floats that differ in their bits. Tables are nothing but floats.
template <typename Table>
int differing(const Table& baked, const Table& computed) {
    static_assert(sizeof(Table) % sizeof(float) == 0);
    const auto *a = reinterpret_cast<const char*>(&baked), *b = reinterpret_cast<const char*>(&computed);
    int count = 0;
    for (std::size_t i = 0; i < sizeof(Table); i += sizeof(float)) count += std::memcmp(a + i, b + i, sizeof(float)) != 0;
    return count;
}

}  // namespace

TEST_CASE("every node of the baked tables is the quadrature's, to the bit") {
    CHECK(differing(baked::ggx, bake::ggx()) == 0);
    CHECK(differing(baked::charlie, bake::charlie()) == 0);
    CHECK(differing(baked::glass_ggx, bake::glass(Distribution::ggx)) == 0);
    CHECK(differing(baked::glass_beckmann, bake::glass(Distribution::beckmann)) == 0);
    CHECK(differing(baked::caught_ggx, bake::caught(Distribution::ggx)) == 0);
    CHECK(differing(baked::caught_beckmann, bake::caught(Distribution::beckmann)) == 0);
}

}  // namespace dg
