#include "render/emitter_passes.h"

#include "math/error.h"
#include "render/flare/flare_pass.h"
#include "render/flare/maps/sheet_pass.h"
#include "render/flare/scatter_pass.h"
#include "render/light_pass.h"

namespace dg {
namespace {

void need_exact(const Camera& camera, const char* what) {
    if (!std::holds_alternative<ExactLens>(camera.lens))
        throw input_error("render", what, "the exact model of a lens", "an ideal lens");
}

std::shared_ptr<const FlareAim> aim_of(const Picture& p) {
    return std::make_shared<const FlareAim>(p.scene, p.camera, p.settings);
}

}  // namespace

void add_emitter_passes(Passes& passes, const Picture& p, const DrawnSamples& drawn, const LightWeight& weight,
                        const PixelCone& cone) {
    const auto [begin, end] = drawn.indices();
    const auto paths = [&](double per_sample) {
        return light_path_range(begin, end, per_sample, p.settings.seed);
    };
    const double per_count = drawn.per_count();
    if (weight.draws_light()) {
        passes.add<StraightLightPass>(paths(p.settings.light.m1), p, weight, cone);
        passes.add<BouncedLightPass>(paths(p.settings.light.m2), p, weight, cone);
    }
    std::shared_ptr<const FlareAim> aim;   // shared by ghosts and scatter
    if (const FlarePlan& plan = p.settings.flare; plan.per_sample > 0) {
        need_exact(p.camera, "flare");
        auto guide = plan.guide ? plan.guide : std::make_shared<const FlareGuide>(aim_of(p), p.settings);
        aim = guide->shared_aim();
        if (!guide->sheets().empty() && p.film.count_of(Layer::bands) > 0)
            throw input_error("render", "flare maps", "a film without bands, or no maps", "a film with bands");
        if (!guide->sheets().empty())
            passes.add(std::make_unique<SheetPass>(p, drawn.indices(), plan.per_sample, per_count, guide));
        if (const double share = guide->paths_share(); share > 0)
            passes.add<FlarePass>(paths(share * plan.per_sample), p, share * plan.per_sample * per_count,
                                  std::move(guide));
    }
    if (const ScatterPlan& plan = p.settings.scatter; plan.per_sample > 0) {
        need_exact(p.camera, "scatter");
        auto guide = plan.guide ? plan.guide
                                : std::make_shared<const ScatterGuide>(aim ? aim : aim_of(p), p.scene, p.camera,
                                                                       p.settings);
        if (!guide->empty())
            passes.add<ScatterPass>(paths(plan.per_sample), p, plan.per_sample * per_count, std::move(guide));
    }
}

}  // namespace dg
