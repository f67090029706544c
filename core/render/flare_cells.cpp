#include "render/flare_cells.h"

namespace dg {

Vec2f FlareCells::sample(Vec2f u) const {
    const float half = 0.5f * blind;
    if (u.x < half) return FlareRectangle{}.at({u.x / half, u.y});
    if (u.x < blind) return outer.at({(u.x - half) / half, u.y});
    const Sample2D s = weights.sample({(u.x - blind) / (1 - blind), u.y});
    return inner.at({s.x, s.y});
}

double FlareCells::pdf(Vec2f at) const {
    const Vec2f in = inner.in(at);
    return 0.5 * blind * (1 / FlareRectangle{}.area() + (outer.holds(at) ? 1 / outer.area() : 0)) +
           (1 - blind) * double(weights.pdf(in.x, in.y)) / inner.area();
}

}  // namespace dg
