#include "render/flare/flare_guide.h"

namespace dg {

std::optional<FlareArrival> FlareGuide::draw(const Random& u) const {
    const DiscreteSample pair = known_.pairs.sample(u.pair);
    const FlareCells& cells = known_.cells[known_.cells_of_pair[pair.index]];
    const Vec2f at = cells.sample(u.front);
    return aim_->aim(pair.index / aim_->ghosts(), pair.index % aim_->ghosts(), at,
                     cells.pdf(at) * double(pair.pmf), {u.select, cells.lambda(u.lambda), u.point, u.moment});
}

}  // namespace dg
