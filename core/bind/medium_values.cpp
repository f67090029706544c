#include "bind/medium_values.h"

namespace dg::bind {
namespace {

SpectralColor to_color(const MediumColor& given) {
    if (const auto* rgb = std::get_if<std::array<float, 3>>(&given)) return {(*rgb)[0], (*rgb)[1], (*rgb)[2]};
    const auto& [nm, values] = std::get<1>(given);
    return std::make_shared<const SampledSpectrum>(nm, values);
}

std::shared_ptr<const DensityGrid> to_grid(const MediumGrid& given) {
    if (!given) return nullptr;
    const auto& [values, matrix] = *given;
    const auto side = [&](std::size_t axis) { return std::uint32_t(values.shape(axis)); };
    return std::make_shared<const DensityGrid>(DensityGrid::Size{side(2), side(1), side(0)}, shared(values),
                                               to_affine(matrix));
}

}  // namespace

std::shared_ptr<const Medium> to_medium(const MediumValues& v) {
    std::vector<PhaseLobe> lobes;
    for (const auto& [mean_cosine, weight] : v.lobes) lobes.push_back({mean_cosine, weight});
    return std::make_shared<const Medium>(
        Medium{to_color(v.absorption), to_color(v.scattering), to_color(v.emission), Phase(lobes), to_grid(v.density)});
}

}  // namespace dg::bind
