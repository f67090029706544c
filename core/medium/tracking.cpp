#include "medium/tracking.h"

#include <cmath>
#include <limits>

namespace dg {
namespace {

double distance_to_next(RayRandom& random, double rate) {
    return rate > 0 ? -std::log1p(-random.next()) / rate : std::numeric_limits<double>::infinity();
}

/// Chooses a wavelength in proportion to its lane.
int choose(Spectrum lanes, double u) {
    double rest = u * kWavelengths;
    int k = 0;
    while (k + 1 < kWavelengths && rest >= lanes[k]) rest -= lanes[k++];
    return k;
}

/// Sampling densities of the tracked distances per wavelength, relative to the wavelength that draws, and the
/// throughput.
class Lanes {
  public:
    Lanes(const MediumAt& medium, Spectrum lanes, bool hero_only, int lane)
        : medium_(medium), lanes_(lanes),
          rate_(hero_only ? Spectrum(medium.extinction[0]) : medium.extinction), lane_(lane) {}

    double rate() const { return double(rate_[lane_]); }
    /// No collision along `length` m with the majorant density `bound`.
    void pass(float bound, double length) {
        const auto over = [&](Spectrum rate) {
            return exp((Spectrum(rate_[lane_]) - rate) * (bound * float(length)));
        };
        density_ *= over(rate_), value_ *= over(medium_.extinction);
    }
    /// A collision: multiplies the densities by the collision rates, without the majorant.
    void collide() { density_ *= rate_ / rate_[lane_]; }
    void carry(Spectrum share) { value_ *= share / rate_[lane_]; }

    Spectrum weight() const { return value_ / (lanes_ * density_).average(); }
    Spectrum lanes() const { return lanes_ * density_ / (lanes_ * density_).average(); }

  private:
    const MediumAt& medium_;
    Spectrum lanes_, rate_, density_{1.f}, value_{1.f};
    int lane_;
};

}  // namespace

Spectrum ratio_tracking(const GridRay& ray, Spectrum extinction, double begin, double end, RayRandom random) {
    Spectrum product{1.f};
    const float strongest = extinction.max();
    BlockTraversal walk(ray.grid, ray.origin, ray.direction, begin, end);
    while (const auto step = walk.next()) {
        const float least = step->bounds.least, range = step->bounds.most - least;
        product *= transmittance(extinction, least * float(step->end - step->begin));
        const double rate = double(range) * strongest;
        for (double t = step->begin + distance_to_next(random, rate); t < step->end;
             t += distance_to_next(random, rate)) {
            const float above = std::clamp((ray.density(t) - least) / range, 0.f, 1.f);
            product *= Spectrum(1.f) - extinction * (above / strongest);
        }
        if (product.is_black()) return 0.f;
    }
    return product;
}

Tracked delta_tracking(const GridRay& ray, const MediumAt& medium, Spectrum lanes, bool hero_only, double begin,
                       double end, RayRandom random) {
    Lanes path(medium, lanes, hero_only, hero_only ? 0 : choose(lanes, random.next()));
    Tracked found;
    BlockTraversal walk(ray.grid, ray.origin, ray.direction, begin, end);
    while (const auto step = walk.next()) {
        const float most = step->bounds.most;
        double t = step->begin;
        for (;;) {
            const double next = t + distance_to_next(random, path.rate() * most);
            path.pass(most, std::min(next, step->end) - t);
            if (!(next < step->end)) break;
            t = next;
            const float dense = std::clamp(ray.density(t) / most, 0.f, 1.f);
            path.collide();
            Lanes shining = path;
            shining.carry(medium.emission * dense);
            found.emitted += shining.weight();
            found.collided = random.next() < dense;
            path.carry(found.collided ? medium.scattering : medium.extinction);
            if (!found.collided) continue;
            found.t = t, found.weight = path.weight(), found.lanes = path.lanes();
            return found;
        }
    }
    found.weight = path.weight(), found.lanes = path.lanes();
    return found;
}

}  // namespace dg
