// material_keys.cpp -- interpolates materials field by field.
#include "material/material_keys.h"

#include <concepts>
#include <tuple>
#include <utility>

#include "math/error.h"

namespace dg {
namespace {

template <typename M, typename T>
concept Is = std::same_as<std::remove_const_t<M>, T>;

// All fields of each struct. Structured bindings must name every field, so a new field does not compile until it is
// listed here.
auto fields(Is<TextureSlot> auto& s) {
    auto& [index, uv_set, m] = s;
    return std::tie(index, uv_set, m[0], m[1], m[2], m[3], m[4], m[5]);
}
auto fields(Is<ClearcoatLayer> auto& l) {
    auto& [a, b, c, d, e, f] = l;
    return std::tie(a, b, c, d, e, f);
}
auto fields(Is<SheenLayer> auto& l) {
    auto& [a, b, c, d] = l;
    return std::tie(a, b, c, d);
}
auto fields(Is<Anisotropy> auto& l) {
    auto& [a, b, c] = l;
    return std::tie(a, b, c);
}
auto fields(Is<Iridescence> auto& l) {
    auto& [a, b, c, d, e, f] = l;
    return std::tie(a, b, c, d, e, f);
}
auto fields(Is<Roughness> auto& a) {
    auto& [u, v, texture, distribution] = a;
    return std::tie(u, v, texture, distribution);
}
auto fields(Is<SpectralColor> auto& c) {
    auto& [rgb, sampled] = c;
    return std::tie(rgb, sampled);
}
auto fields(Is<DiffuseMaterial> auto& m) {
    auto& [a, b, c, d] = m;
    return std::tie(a, b, c, d);
}
auto fields(Is<ConductorMaterial> auto& m) {
    auto& [a, b, c, d, e, f] = m;
    return std::tie(a, b, c, d, e, f);
}
auto fields(Is<DielectricMaterial> auto& m) {
    auto& [a, b, c, d, e, f, g, h] = m;
    return std::tie(a, b, c, d, e, f, g, h);
}
auto fields(Is<CoatedMaterial> auto& m) {
    auto& [a, b, c, d, e, f, g, h, i, j] = m;
    return std::tie(a, b, c, d, e, f, g, h, i, j);
}
auto fields(Is<MixMaterial> auto& m) {
    auto& [first, second, amount, texture, parts] = m;
    return std::tie(first, second, amount, texture, parts[0], parts[1]);
}
auto fields(Is<BoundaryMaterial> auto&) { return std::tie(); }
auto fields(Is<GltfMaterial> auto& m) {
    auto& [a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, c0, c1,
           c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6] = m;
    return std::tie(a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9,
                    c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6);
}

/// Types without numbers.
template <typename T>
concept Whole = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, SharedSpectrum> ||
                std::same_as<T, MixPart>;

/// Calls `number(a, b)` for each pair of floats, and `other(a, b)` for each pair of other fields.
template <typename Number, typename Other>
struct Pairs {
    Number number;
    Other other;

    void visit(float& a, const float& b) { number(a, b); }
    void visit(Rgb& a, const Rgb& b) {
        for (int i = 0; i < 3; ++i) number(a[i], b[i]);
    }
    template <Whole T>
    void visit(T& a, const T& b) {
        other(a, b);
    }
    template <typename T>
    void visit(T& a, const T& b) {
        auto all_a = fields(a);
        const auto all_b = fields(b);
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (visit(std::get<I>(all_a), std::get<I>(all_b)), ...);
        }(std::make_index_sequence<std::tuple_size_v<decltype(all_a)>>());
    }
};

/// Skips the name, since copying it would cost more than all numbers.
template <typename Number, typename Other>
void each_pair(Material& a, const Material& b, Number number, Other other) {
    Pairs<Number, Other> pairs{number, other};
    auto& [a_name, a_kind, a0, a1, a2, a3, a4, a5, a6, a7, a8] = a;
    const auto& [b_name, b_kind, b0, b1, b2, b3, b4, b5, b6, b7, b8] = b;
    const auto visit = [&](auto& x, const auto& y) { pairs.visit(x, y); };
    visit(a0, b0), visit(a1, b1), visit(a2, b2), visit(a3, b3), visit(a4, b4);
    visit(a5, b5), visit(a6, b6), visit(a7, b7), visit(a8, b8);
    std::visit(
        [&](auto& kind) {
            const auto* same = std::get_if<std::remove_cvref_t<decltype(kind)>>(&b.kind);
            if (same) pairs.visit(kind, *same);
        },
        a_kind);
}

constexpr auto kNothing = [](auto&, const auto&) {};

Material without_name(const Material& m) {
    return {{}, m.kind, m.emission, m.two_sided_emission, m.profile, m.opacity, m.opacity_texture,
            m.normal_texture, m.normal_scale, m.two_sided, m.emission_texture};
}

/// Clamped to the values at both keys, which have been validated.
void go_toward(float& a, float b, float share) {
    if (a == b || (!std::isfinite(b - a) && share < 1)) return;
    a = share < 1 ? std::clamp(a * (1 - share) + b * share, std::min(a, b), std::max(a, b)) : b;
}

bool same_but_numbers(const Material& a, const Material& b) {
    if (a.kind.index() != b.kind.index()) return false;
    bool same = true;
    Material copy = without_name(a);
    each_pair(
        copy, b, [](float&, float) {},
        [&](const auto& x, const auto& y) { same = same && x == y; });
    return same;
}

}  // namespace

Material blend(const Material& a, const Material& b, float share) {
    Material m = without_name(a);
    each_pair(m, b, [&](float& x, float y) { go_toward(x, y, share); }, kNothing);
    return m;
}

void validate(std::span<const Material> keys, const std::vector<Texture>& textures) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        validate(keys[i], textures);
        if (same_but_numbers(keys[0], keys[i])) continue;
        throw Error("material '" + keys[0].name + "': key " + std::to_string(i) +
                    ": must have the kind, textures and modes of key 0: only numbers change over time");
    }
}

MaterialRange range_of(const Keyed<Material>& keys) {
    MaterialRange range{keys.values[0], keys.values[0]};
    for (const Material& key : keys.values) {
        each_pair(range.least, key, [](float& x, float y) { x = std::min(x, y); }, kNothing);
        each_pair(range.most, key, [](float& x, float y) { x = std::max(x, y); }, kNothing);
    }
    return range;
}

Material brightest(const Keyed<Material>& keys, const MaterialRange& range) {
    Material m = keys.values[0];
    m.emission = range.most.emission;
    m.opacity = range.most.opacity;
    auto* gltf = std::get_if<GltfMaterial>(&m.kind);
    if (!gltf) return m;
    const auto &least = std::get<GltfMaterial>(range.least.kind),
               &most = std::get<GltfMaterial>(range.most.kind);
    gltf->emissive = most.emissive;
    gltf->base_color = most.base_color;
    gltf->base_alpha = most.base_alpha;
    gltf->alpha_cutoff = least.alpha_cutoff;
    gltf->clearcoat.factor = least.clearcoat.factor;
    return m;
}

Clear clearness(const MaterialRange& range) {
    Material clearest = without_name(range.least);
    if (auto* m = std::get_if<GltfMaterial>(&clearest.kind))
        m->transmission = std::get<GltfMaterial>(range.most.kind).transmission;
    if (auto* d = std::get_if<DielectricMaterial>(&clearest.kind))
        if (d->ior <= 1 && std::get<DielectricMaterial>(range.most.kind).ior >= 1) d->ior = 1;
    return clearness(clearest);
}

const Material& MixPart::most() const { return change ? change->range.most : *still; }

MaterialAt::MaterialAt(const Keyed<Material>& keys, float time)
    : now_(new Material(keys.at(time))), own_(now_) {}

void MaterialAt::Delete::operator()(const Material* m) const {
    delete m;
}

}  // namespace dg
