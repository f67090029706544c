#include "material/material_needs.h"

#include <algorithm>

namespace dg {
namespace {

// GGX alpha above which a lobe is too wide for visible caustics.
constexpr float kNarrowAlpha = 0.1f;

bool any_used(std::initializer_list<TextureSlot> slots) {
    return std::ranges::any_of(slots, [](const TextureSlot& s) { return s.used(); });
}

bool looks(const DiffuseMaterial& m) { return any_used({m.reflectance_texture, m.transmittance_texture}); }
bool looks(const ConductorMaterial& m) { return any_used({m.reflectance_texture, m.alpha.texture}); }
bool looks(const DielectricMaterial& m) { return m.alpha.texture.used(); }
bool looks(const CoatedMaterial& m) {
    return m.alpha.texture.used() || (m.metal ? looks(m.conductor) : looks(m.diffuse));
}
bool looks(const MixMaterial& m) {
    return m.amount_texture.used() ||
           std::ranges::any_of(m.parts, [](const MixPart& p) { return uses_textures(p.most()); });
}
bool looks(const BoundaryMaterial&) { return false; }
bool looks(const GltfMaterial& m) {
    return any_used({m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.emissive_texture,
                     m.specular_texture, m.specular_color_texture, m.transmission_texture,
                     m.diffuse_transmission_texture, m.diffuse_transmission_color_texture,
                     m.specular_glossiness_texture, m.clearcoat.texture, m.clearcoat.roughness_texture,
                     m.clearcoat.normal_texture, m.sheen.color_texture, m.sheen.roughness_texture,
                     m.anisotropy.texture, m.iridescence.texture, m.iridescence.thickness_texture});
}

int frame_set(const Roughness& a) {
    if (a.plain()) return -1;
    return a.texture.used() ? a.texture.uv_set : 0;
}
int frame_set(const DiffuseMaterial&) { return -1; }
int frame_set(const ConductorMaterial& m) { return frame_set(m.alpha); }
int frame_set(const DielectricMaterial& m) { return frame_set(m.alpha); }
int frame_set(const CoatedMaterial& m) {
    const int coat = frame_set(m.alpha);
    return coat < 0 && m.metal ? frame_set(m.conductor) : coat;
}
int frame_set(const MixMaterial& m) {
    const int first = tangent_set(m.parts[0].most());
    return first < 0 ? tangent_set(m.parts[1].most()) : first;
}
int frame_set(const BoundaryMaterial&) { return -1; }
int frame_set(const GltfMaterial& m) {
    if (m.normal_texture.used()) return m.normal_texture.uv_set;
    if (m.clearcoat.used() && m.clearcoat.normal_texture.used()) return m.clearcoat.normal_texture.uv_set;
    if (!m.anisotropy.used()) return -1;
    return m.anisotropy.texture.used() ? m.anisotropy.texture.uv_set : 0;
}

bool reflects(const DiffuseMaterial& m) { return m.transmittance.is_black(); }
bool reflects(const ConductorMaterial&) { return true; }
bool reflects(const DielectricMaterial&) { return false; }
bool reflects(const CoatedMaterial&) { return true; }
bool reflects(const MixMaterial& m) {
    return std::ranges::all_of(m.parts, [](const MixPart& p) { return only_reflects(p.most()); });
}
bool reflects(const BoundaryMaterial&) { return false; }
bool reflects(const GltfMaterial& m) { return m.transmission <= 0 && m.diffuse_transmission <= 0; }

bool gathers(const DiffuseMaterial&) { return false; }
bool gathers(const ConductorMaterial& m) { return m.alpha.widest() < kNarrowAlpha; }
bool gathers(const DielectricMaterial& m) { return m.ior != 1 && !m.thin && m.alpha.widest() < kNarrowAlpha; }
bool gathers(const CoatedMaterial& m) { return m.metal && gathers(m.conductor); }
bool gathers(const MixMaterial& m) {
    return std::ranges::any_of(m.parts, [](const MixPart& p) { return makes_caustics(p.most()); });
}
bool gathers(const BoundaryMaterial&) { return false; }
bool gathers(const GltfMaterial& m) {
    if (m.unlit || m.roughness * m.roughness >= kNarrowAlpha) return false;
    return (m.transmission > 0 && m.thickness > 0) || m.metallic > 0.5f;
}

}  // namespace

bool uses_textures(const Material& material) {
    return any_used({material.opacity_texture, material.normal_texture, material.emission_texture}) ||
           std::visit([](const auto& m) { return looks(m); }, material.kind);
}

int tangent_set(const Material& material) {
    if (material.normal_texture.used()) return material.normal_texture.uv_set;
    return std::visit([](const auto& m) { return frame_set(m); }, material.kind);
}

bool is_mixture(const Material& material) { return std::holds_alternative<MixMaterial>(material.kind); }

bool only_reflects(const Material& material) {
    return std::visit([](const auto& m) { return reflects(m); }, material.kind);
}

bool makes_caustics(const Material& material) {
    return std::visit([](const auto& m) { return gathers(m); }, material.kind);
}

void link_mixtures(std::vector<Material>& materials, const std::vector<std::unique_ptr<MaterialChange>>& changes) {
    const auto part = [&](std::uint32_t i) {
        return MixPart{&materials[i], changes.empty() ? nullptr : changes[i].get()};
    };
    const auto link = [&](Material& material) {
        auto* mix = std::get_if<MixMaterial>(&material.kind);
        if (!mix) return;
        mix->parts[0] = part(mix->first);
        mix->parts[1] = part(mix->second);
    };
    std::ranges::for_each(materials, link);
    for (const auto& change : changes) {
        if (!change) continue;
        std::ranges::for_each(change->keys.values, link);
        link(change->range.least);
        link(change->range.most);
    }
}

}  // namespace dg
