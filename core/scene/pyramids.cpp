#include "scene/pyramids.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace dg {
namespace {

std::vector<char> weighed_by_alpha(std::size_t count, const std::vector<Material>& materials) {
    std::vector<char> weighed(count, false);
    for (const Material& material : materials) {
        const auto* m = std::get_if<GltfMaterial>(&material.kind);
        if (m && m->alpha_mode != GltfMaterial::AlphaMode::opaque && m->base_color_texture.used())
            weighed[m->base_color_texture.index] = true;
    }
    return weighed;
}

const void* first_value(const Texture& t) {
    return std::visit([](const auto& p) { return static_cast<const void*>(p.data()); }, t.pixels);
}

bool wants_pyramid(const Texture& t) {
    return t.min_filter.between != MinFilter::Mip::none;
}

}  // namespace

void build_pyramids(std::vector<Texture>& textures, const std::vector<Material>& materials) {
    const std::vector<char> weighed = weighed_by_alpha(textures.size(), materials);
    const auto same = [&](std::size_t a, std::size_t b) {
        const Texture &s = textures[a], &t = textures[b];
        return wants_pyramid(s) && first_value(s) == first_value(t) && s.srgb == t.srgb &&
               s.width == t.width && s.height == t.height && s.channels == t.channels &&
               weighed[a] == weighed[b];
    };
    std::vector<std::size_t> first(textures.size());  // first texture with the same pyramid
    for (std::size_t i = 0; i < textures.size(); ++i)
        for (first[i] = 0; first[i] < i && !same(first[i], i);) ++first[i];
    oneapi::tbb::parallel_for(std::size_t(0), textures.size(), [&](std::size_t i) {
        if (first[i] == i && wants_pyramid(textures[i]))
            textures[i].pyramid = build_pyramid(textures[i], weighed[i]);
    });
    for (std::size_t i = 0; i < textures.size(); ++i)
        if (wants_pyramid(textures[i])) textures[i].pyramid = textures[first[i]].pyramid;
}

}  // namespace dg
