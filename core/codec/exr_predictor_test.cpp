// exr_predictor_test.cpp -- the predictor of OpenEXR, applied and undone.
#include "codec/exr_predictor.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/hash.h"

using namespace dg;

namespace {

using Vec = std::vector<std::uint8_t>;

/// Predictor of the Technical Introduction: even bytes, odd bytes, differences plus 128.
Vec packed(const Vec& pixels) {
    Vec out;
    for (std::size_t first : {0, 1})
        for (std::size_t i = first; i < pixels.size(); i += 2) out.push_back(pixels[i]);
    for (std::size_t i = out.size(); i-- > 1;) out[i] = std::uint8_t(out[i] - out[i - 1] + 128);
    return out;
}

}  // namespace

TEST_CASE("the predictor of OpenEXR is undone, whatever the number of bytes") {
    for (std::size_t size : {0, 1, 2, 3, 4, 5, 16, 17, 4096, 4097}) {
        Vec pixels(size), found(size);
        for (std::size_t i = 0; i < size; ++i) pixels[i] = std::uint8_t(hash64(i, size));
        undo_exr_predictor(packed(pixels), found);
        CHECK(found == pixels);
    }
}

TEST_CASE("the predictor of OpenEXR by hand: 10 20 30 40 is packed as 10, 30 - 10, 20 - 30, 40 - 20, plus 128") {
    const Vec stream{10, 148, 118, 148};
    Vec found(4);
    undo_exr_predictor(stream, found);
    CHECK(found == Vec{10, 20, 30, 40});
}

TEST_CASE("as many bytes are wanted as there are") {
    const Vec stream{1, 2, 3, 4};
    Vec found(3);
    CHECK_THROWS_WITH(undo_exr_predictor(stream, found), doctest::Contains("wanted 4, got 3"));
}
