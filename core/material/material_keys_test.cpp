// material_keys_test.cpp -- materials between keys.
#include "material/material_keys.h"

#include <doctest/doctest.h>

#include <cstring>

#include "math/error.h"

using namespace dg;

namespace {

constexpr std::size_t kWords = sizeof(GltfMaterial) / 4;

/// A material with this number in every field except modes.
GltfMaterial filled(float number) {
    GltfMaterial m;
    float words[kWords];
    std::fill(std::begin(words), std::end(words), number);
    std::memcpy(static_cast<void*>(&m), words, sizeof words);
    m.alpha_mode = GltfMaterial::AlphaMode::mask;
    m.double_sided = m.specular_glossiness = m.unlit = false;
    return m;
}

Keyed<Material> keys(Material a, Material b) {
    return {{0, 1}, {std::move(a), std::move(b)}};
}

Material gltf(GltfMaterial m) {
    return {"it", m};
}

}  // namespace

TEST_CASE("every number of a material goes half the way, and nothing else does") {
    static_assert(sizeof(GltfMaterial) % 4 == 0);
    const Material half = blend(gltf(filled(0.25f)), gltf(filled(0.75f)), 0.5f);
    float words[kWords];
    std::memcpy(words, &std::get<GltfMaterial>(half.kind), sizeof words);
    const auto changed = std::count(std::begin(words), std::end(words), 0.5f);
    constexpr int kSlots = 19, kModes = 4;  // index and set of each slot
    CHECK(changed == std::ptrdiff_t(kWords) - 2 * kSlots - kModes);

    const Material a{"a", DielectricMaterial{1.2f, 0.2f, {0, 0.2f, 0.4f}, 1}, {1, 2, 3}};
    const Material b{"b", DielectricMaterial{1.4f, 0.4f, {1, 0.4f, 0.6f}, 3}, {3, 4, 5}};
    const Material m = blend(a, b, 0.25f);
    const auto& d = std::get<DielectricMaterial>(m.kind);
    CHECK(d.ior == doctest::Approx(1.25));
    CHECK(d.alpha.u == doctest::Approx(0.25));
    CHECK(d.tint.rgb.x == doctest::Approx(0.25));
    CHECK(d.tint.rgb.z == doctest::Approx(0.45));
    CHECK(d.dispersion == doctest::Approx(1.5));
    CHECK(m.emission == Rgb{1.5f, 2.5f, 3.5f});
}

TEST_CASE("blending never leaves the range of the keys, and infinite lengths wait") {
    GltfMaterial a, b;
    a.roughness = 0.3f, b.roughness = 0.3000001f;
    b.attenuation_distance = 2;
    for (int i = 0; i <= 1000; ++i) {
        const Material m = blend(gltf(a), gltf(b), float(i) / 1000);
        const auto& g = std::get<GltfMaterial>(m.kind);
        CHECK(g.roughness >= a.roughness);
        CHECK(g.roughness <= b.roughness);
        CHECK(g.attenuation_distance == (i < 1000 ? a : b).attenuation_distance);
        CHECK(g.metallic == 1);
    }
}

TEST_CASE("keys of another kind, texture or mode are refused, and so are numbers out of range") {
    const std::vector<Texture> textures{{"one", 1, 1, 1, std::vector<std::uint8_t>{1}}};
    GltfMaterial a;
    validate(std::vector{gltf(a), gltf(a)}, textures);
    const auto metal = [](Distribution d) { return Material{"it", ConductorMaterial{{1, 1, 1}, {0.2f, 0.2f, {}, d}}}; };
    CHECK_THROWS_AS(validate(std::vector{metal(Distribution::ggx), metal(Distribution::beckmann)}, textures), Error);
    for (int fault = 0; fault < 5; ++fault) {
        GltfMaterial b = a;
        Material other = gltf(b);
        if (fault == 0) other = {"it", DiffuseMaterial{}};
        if (fault == 1) b.alpha_mode = GltfMaterial::AlphaMode::blend;
        if (fault == 2) b.base_color_texture.index = 0;
        if (fault == 3) b.unlit = true;
        if (fault == 4) b.roughness = 2;
        if (fault > 0) other = gltf(b);
        CAPTURE(fault);
        CHECK_THROWS_AS(validate(std::vector{gltf(a), other}, textures), Error);
    }
    const Material diffuse{"it", DiffuseMaterial{}};
    CHECK_THROWS_WITH(validate(std::vector{gltf(a), diffuse}, textures),
                      doctest::Contains("material 'it': key 1: must have the kind, textures and modes of key 0"));
}

TEST_CASE("what may be clear at some time is clear for shadow rays, at whatever key it is not") {
    GltfMaterial rough, dark;
    rough.transmission = 1;  // clear only between the keys, near the end
    dark.roughness = dark.metallic = 0;
    CHECK(clearness(gltf(rough)) == Clear::no);
    CHECK(clearness(gltf(dark)) == Clear::no);
    CHECK(clearness(range_of(keys(gltf(rough), gltf(dark)))) == Clear::sheet);
    dark.thickness = rough.thickness = 0.1f;
    CHECK(clearness(range_of(keys(gltf(rough), gltf(dark)))) == Clear::volume);
    const auto glass = [](float ior) { return Material{"it", DielectricMaterial{ior}}; };
    CHECK(clearness(range_of(keys(glass(1), glass(1.5f)))) == Clear::sheet);
    CHECK(clearness(range_of(keys(glass(1.4f), glass(1.5f)))) == Clear::volume);
}
