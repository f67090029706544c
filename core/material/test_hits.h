// test_hits.h -- for tests only: hits, texels and lanes that the tests of materials share.
#pragma once
#include "material/material.h"

namespace dg::test {

/// A basis whose parts can be told apart; it sums to 1 as the real one does.
inline Wavelengths wavelengths() {
    Wavelengths w = Wavelengths::sample(0.4f);
    w.red = {0, 0, 1, 0.25f};
    w.green = {0, 1, 0, 0.5f};
    w.blue = {1, 0, 0, 0.25f};
    return w;
}

/// On a surface that faces +z.
inline SurfaceHit hit_from(Vec3f wo) {
    SurfaceHit h;
    h.ng = h.ns = {0, 0, 1};
    h.tangent = {1, 0, 0};
    h.uv[0] = {0.25f, 0.5f};
    h.uv[1] = {0.75f, 0.5f};
    h.wo = normalize(wo);
    h.front = h.wo.z > 0;
    return h;
}

/// One texel, linear bytes.
inline Texture texel(std::initializer_list<std::uint8_t> values) {
    Texture t;
    t.width = t.height = 1;
    t.channels = static_cast<int>(values.size());
    t.pixels = std::vector<std::uint8_t>(values);
    return t;
}

inline TextureSlot slot(int index, int uv_set = 0) {
    TextureSlot s;
    s.index = index;
    s.uv_set = uv_set;
    return s;
}

}  // namespace dg::test
