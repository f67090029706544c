#include "render/plan_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/plan_curves.h"

namespace dg {
namespace {

constexpr double kSure = 2;   // standard errors
// Limit of a sample's cost with light paths, relative to its cost without them: users choose the number of samples with
// a time in mind. A higher limit seldom gains a third: if light paths find everything, cost x error is proportional to
// 1 + 1 / (cost - 1).
constexpr double kMostCost = 4;
// Limit of the cost of bounced paths relative to camera samples: rare light would demand an unlimited number of paths.
constexpr double kMostBounced = 1;

struct Candidate {
    int straight = 0, bounced = 0;
};

enum class Verdict { no, unsure, yes };

class Judge {
  public:
    Judge(const NoiseCurves& straight, const NoiseCurves& bounced, double rest, const PlanCosts& costs)
        : straight_(straight), bounced_(bounced), rest_(rest), costs_(costs) {}

    /// log of cost x error of `b` over cost x error of `a`. `bounces`: adds the light found by bounced light paths to
    /// the light seen by camera samples. Their overlap is unknown and may count twice, which underestimates the gain.
    double gain(Candidate a, Candidate b, bool bounces, int left_out = kAll) const {
        return std::log(cost(b) * error(b, bounces, left_out)) -
               std::log(cost(a) * error(a, bounces, left_out));
    }
    /// Whether the gain exceeds kWorth, with its standard error by the jackknife over groups of paths.
    Verdict verdict(Candidate a, Candidate b, bool bounces) const {
        std::array<double, kGroups> gains;
        for (int g = 0; g < kGroups; ++g) gains[g] = gain(a, b, bounces, g);
        const double mean = std::accumulate(gains.begin(), gains.end(), 0.0) / kGroups;
        double variance = 0;
        for (const double x : gains) variance += (x - mean) * (x - mean);
        variance *= double(kGroups - 1) / kGroups;
        const double more = gain(a, b, bounces) - std::log(kWorth), error = kSure * std::sqrt(variance);
        return more > error ? Verdict::yes : more > -error ? Verdict::unsure : Verdict::no;
    }
    /// The best candidate within the cost limits.
    Candidate best(bool bounces) const {
        Candidate found;
        for (int k2 = 0; k2 < (bounces ? kCandidates : 1); ++k2)
            for (int k1 = 0; k1 < kCandidates; ++k1)
                if (allowed({k1, k2}) && gain({k1, k2}, found, bounces) > 0)
                    found = {k1, k2};
        return found;
    }

  private:
    double error(Candidate c, bool bounces, int g) const {
        const double others = rest_ + (bounces ? bounced_[g][c.bounced] : 0);
        return std::max(1e-300, straight_[g][c.straight] + others);
    }
    /// Cost of one sample of every pixel with its light paths.
    double cost(Candidate c) const {
        const double sharing = c.straight + c.bounced > 0 ? costs_.sharing : 0;
        return costs_.camera + sharing + costs_.straight * paths_of(c.straight) + bounced_cost(c);
    }
    double bounced_cost(Candidate c) const {
        return c.bounced > 0 ? costs_.sharing_bounced + costs_.bounced * paths_of(c.bounced) : 0;
    }
    bool allowed(Candidate c) const {
        return cost(c) <= kMostCost * costs_.camera &&
               bounced_cost(c) <= kMostBounced * costs_.camera;
    }

    const NoiseCurves& straight_;
    const NoiseCurves& bounced_;
    double rest_;   // variance of the camera's light without direct emission
    const PlanCosts& costs_;
};

}  // namespace

PlanChoice choose_plan(const PilotPicture& picture, const PilotArrivals& straight,
                       const PilotArrivals& bounced, const PlanCosts& costs) {
    const std::vector<Vec3f> weights = weights_of(picture, straight);
    const std::vector<PilotArrival> usual = seen(bounced, weights);
    const NoiseCurves of_straight = curves_of(straight, weights, picture.pixels),
                 of_bounced = curves_of({usual, bounced.paths}, weights, picture.pixels);
    const Judge judge(of_straight, of_bounced, rest_of(picture, weights), costs);
    Candidate plan = judge.best(false);
    Verdict verdict = judge.verdict(plan, {}, false);
    bool sure = verdict != Verdict::unsure;
    if (verdict != Verdict::yes) plan = {};
    if (!usual.empty()) {
        const Candidate bounces = judge.best(true);
        verdict = bounces.bounced > 0 ? judge.verdict(bounces, plan, true) : Verdict::no;
        sure = sure && verdict != Verdict::unsure;
        if (verdict == Verdict::yes) plan = bounces;
    }
    return {{paths_of(plan.straight), paths_of(plan.bounced)}, sure};
}

}  // namespace dg
