#include "render/flare/flare_cells.h"

namespace dg {

FlareCells FlareCells::evenly(const FlareRectangle& front) {
    FlareCells cells;
    cells.inner = cells.outer = cells.front = front;
    cells.blind = 0.05f;
    return cells;
}

Vec2f FlareCells::sample(Vec2f u) const {
    if (u.x < blind) {
        const float v = u.x / blind;
        if (v < kOuter) return outer.at({v / kOuter, u.y});
        if (v < kOuter + kFront) return front.at({(v - kOuter) / kFront, u.y});
        return FlareRectangle{}.at({(v - kOuter - kFront) / (1 - kOuter - kFront), u.y});
    }
    const Vec2f rest{(u.x - blind) / (1 - blind), u.y};
    if (weights.empty()) return inner.at(rest);
    const Sample2D s = weights.sample(rest);
    return inner.at({s.x, s.y});
}

double FlareCells::pdf(Vec2f at) const {
    const auto evenly = [&](const FlareRectangle& where) { return where.holds(at) ? 1.0 / where.area() : 0.0; };
    const Vec2f in = inner.in(at);
    const double cells = weights.empty() ? evenly(inner) : double(weights.pdf(in.x, in.y)) / inner.area();
    const double elsewhere =
        kOuter * evenly(outer) + kFront * evenly(front) + (1 - kOuter - kFront) * evenly(FlareRectangle{});
    return blind * elsewhere + (1 - blind) * cells;
}

FlareLambda FlareCells::lambda(float u) const {
    FlareLambda four(u);
    if (wavelengths.empty()) return four;
    for (int k = 0; k < kWavelengths; ++k) {
        const ContinuousSample1D drawn = wavelengths.sample_continuous(four.u[k]);
        four.u.set(k, drawn.x), four.density.set(k, drawn.pdf);
    }
    return four;
}

}  // namespace dg
