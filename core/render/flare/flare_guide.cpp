#include "render/flare/flare_guide.h"

#include <algorithm>

namespace dg {
namespace {

std::vector<bool> mapped(const FlareAim& aim, const FlareSheets& sheets) {
    std::vector<bool> own(std::size_t(aim.sources().count()));
    for (std::size_t s = 0; s < own.size(); ++s) own[s] = sheets.has(int(s));
    return own;
}

}  // namespace

FlareGuide::FlareGuide(std::shared_ptr<const FlareAim> aim, const RenderSettings& settings)
    : aim_(std::move(aim)),
      sheets_(*aim_, settings),
      known_(settings.flare.learned ? learn_flare(*aim_, settings.threads, mapped(*aim_, sheets_))
                                    : naive_flare(*aim_)) {}

double FlareGuide::paths_share() const {
    constexpr double kLeast = 0.1;   // for ghosts with four reflections of sources with maps
    if (!has_paths()) return 0;
    if (sheets_.empty()) return 1;
    double own = 0, all = 0;
    for (int s = 0; s < aim_->sources().count(); ++s) {
        const double strength = aim_->sources().strength(s);
        all += strength, own += sheets_.has(s) ? 0 : strength;
    }
    return all > 0 ? std::max(own / all, kLeast) : 1;
}

std::optional<FlareArrival> FlareGuide::draw(const Random& u) const {
    const DiscreteSample pair = known_.pairs.sample(u.pair);
    const FlareCells& cells = known_.cells[known_.cells_of_pair[pair.index]];
    const Vec2f at = cells.sample(u.front);
    return aim_->aim(pair.index / aim_->ghosts(), pair.index % aim_->ghosts(), at,
                     cells.pdf(at) * double(pair.pmf), {u.select, cells.lambda(u.lambda), u.point, u.moment});
}

}  // namespace dg
