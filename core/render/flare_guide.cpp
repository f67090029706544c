#include "render/flare_guide.h"

namespace dg {

std::optional<FlareArrival> FlareGuide::draw(float u_pair, Vec2f front, const FlareAim::Random& u) const {
    const DiscreteSample pair = known_.pairs.sample(u_pair);
    const int source = pair.index / aim_.ghosts(), ghost = pair.index % aim_.ghosts();
    const int cells = known_.cells_of_pair[pair.index];
    const Vec2f at = cells < 0 ? FlareRectangle{}.at(front) : known_.cells[cells].sample(front);
    const double pdf = cells < 0 ? 1 / FlareRectangle{}.area() : known_.cells[cells].pdf(at);
    return aim_.aim(source, ghost, at, pdf * double(pair.pmf), u);
}

}  // namespace dg
