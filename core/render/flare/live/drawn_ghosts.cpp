#include "render/flare/live/drawn_ghosts.h"

#include <algorithm>

#include "render/flare/flare_tiles.h"
#include "render/parallel.h"

namespace dg {

std::vector<DrawnGhost> ghosts_of(const FlareAim& aim, const LiveSource& source, const Sensor& sensor,
                                  const std::vector<std::optional<KnownGhost>>* known, int threads) {
    std::vector<DrawnGhost> all;
    for (int pair = 0; pair < aim.pairs(); ++pair)
        if (!known || (*known)[std::size_t(pair)]) all.push_back({pair, nullptr, nullptr});
    parallel_tasks(threads, std::int64_t(all.size()), [&](std::int64_t i) {
        DrawnGhost& own = all[std::size_t(i)];
        own.rays = std::make_unique<MapRays>(aim.camera(), sensor, aim.ghost_lens(), aim.steps(own.pair), source.small.shape);
        const auto key = std::uint64_t(source.small.source) * std::uint64_t(aim.pairs()) + std::uint64_t(own.pair);
        own.ghost = std::make_unique<LiveGhost>(*own.rays, source, sensor, key,
                                                known ? &*(*known)[std::size_t(own.pair)] : nullptr);
    });
    return all;
}

double choose(std::vector<DrawnGhost>& all, const Sensor& sensor, double dim) {
    std::erase_if(all, [](const DrawnGhost& own) { return own.ghost->empty(); });
    FlareTiles tiles(sensor);
    for (const DrawnGhost& own : all) own.ghost->add_to(tiles);
    tiles.finish();
    double worth = 0;
    for (DrawnGhost& own : all) worth += own.worth = own.ghost->weigh(tiles);
    std::ranges::stable_sort(all, std::greater{}, &DrawnGhost::worth);
    double left = worth;
    std::size_t count = 0;
    while (count < all.size() && left > dim * worth) left -= all[count++].worth;
    all.erase(all.begin() + std::ptrdiff_t(count), all.end());
    return worth - left;
}

}  // namespace dg
