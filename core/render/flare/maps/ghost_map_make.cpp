// ghost_map_make.cpp -- subdivides the front into the cells of a ghost's map.
#include <algorithm>

#include "render/flare/maps/ghost_map_maker.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kGrid = 25, kZooms = 4;   // rays along an axis in the search for the region; zoom steps
// Cells of this level are not divided where rays are lost: the whole cell uses exact rays, or none.
constexpr int kLastLost = 5;
constexpr int kSoundLevel = 4;   // level of cells of the size of the squares that are searched for sound rays

Vec2f node_at(int n) { return {float(n % GhostMap::kSide) / 3, float(n / GhostMap::kSide) / 3}; }

}  // namespace

GhostMapMaker::GhostMapMaker(GhostMap& map, const MapRays& rays, const Sensor& sensor, float reach,
                             const GhostMap::Accuracy& accuracy)
    : map_(map), rays_(rays), sensor_(sensor), reach_(reach), accuracy_(accuracy) {}

void GhostMapMaker::make() {
    map_.crossings_ = rays_.crossings(), map_.iris_ = &rays_.ghosts().tables().iris;
    std::vector<Draft> drafts, next;
    if (!zoom()) return;
    const float first = 1.f / GhostMap::kFirstAcross;
    constexpr int across = GhostMap::kFirstAcross;
    find_sound();
    for (int i = 0; i < across * across; ++i)
        propose({{float(i % across) * first, float(i / across) * first}, first, 0}, drafts);
    for (; !drafts.empty(); drafts.swap(next)) next.clear(), refine(drafts, next);
    sort();
}

/// Processes cells of one size, with all their rays traced together.
void GhostMapMaker::refine(const std::vector<Draft>& drafts, std::vector<Draft>& next) {
    Rays rays;
    for (const Draft& d : drafts) look(d, rays);
    const Landings seen = trace(rays);
    std::vector<std::size_t> good;
    std::vector<CellBlur> blurs;
    rays.clear();
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        const MapLanding* const own = &seen[i * kLook];
        CellBlur blur;
        switch (judge(own, drafts[i].level, blur)) {
            case Verdict::dark:
                break;
            case Verdict::rough:
                divide(drafts[i], next);
                break;
            case Verdict::lost:
                if (drafts[i].level < kLastLost)
                    divide(drafts[i], next);
                else if (std::any_of(own, own + kSeen, [](const MapLanding& l) { return l.sound; }))
                    give_up(drafts[i]);
                break;
            case Verdict::smooth:
                good.push_back(i), blurs.push_back(blur), complete(drafts[i], rays);
        }
    }
    const Landings more = trace(rays);
    for (std::size_t k = 0; k < good.size(); ++k)
        if (!add(drafts[good[k]], &seen[good[k] * kLook], &more[k * std::size_t(kMore)], blurs[k]))
            divide(drafts[good[k]], next);
}

/// Narrows the region to where light may enter; false: no light enters.
bool GhostMapMaker::zoom() {
    for (int round = 0; round < kZooms; ++round) {
        Rays rays;
        for (int i = 0; i < kGrid * kGrid; ++i) {
            const Vec2f u{float(i % kGrid) / (kGrid - 1), float(i / kGrid) / (kGrid - 1)};
            rays.push_back({map_.region_.at(u), {0, 0}, lambda_node(kMiddle)});
        }
        const Landings seen = trace(rays);
        Vec2f low{1, 1}, high{0, 0};
        for (int y = 0; y + 1 < kGrid; ++y)
            for (int x = 0; x + 1 < kGrid; ++x) {
                const MapLanding* const own = &seen[y * kGrid + x];
                if (dark_square({own, own + 1, own + kGrid, own + kGrid + 1})) continue;
                low = {std::min(low.x, float(x) / (kGrid - 1)), std::min(low.y, float(y) / (kGrid - 1))};
                high = {std::max(high.x, float(x + 1) / (kGrid - 1)), std::max(high.y, float(y + 1) / (kGrid - 1))};
            }
        if (!(high.x > low.x)) return false;
        const FlareRectangle old = map_.region_;
        map_.region_ = {old.at(low), {old.size.x * (high.x - low.x), old.size.y * (high.y - low.y)}};
        if (map_.region_.area() > 0.5f * old.area()) break;
    }
    return true;
}

/// Marks squares with a sound ray at a corner, and their neighbours.
void GhostMapMaker::find_sound() {
    constexpr int across = GhostMap::kFirstAcross << kSoundLevel;
    Rays rays;
    for (int i = 0; i < (across + 1) * (across + 1); ++i) {
        const Vec2f u{float(i % (across + 1)) / across, float(i / (across + 1)) / across};
        rays.push_back({map_.region_.at(u), {0, 0}, lambda_node(kMiddle)});
    }
    const Landings seen = trace(rays);
    near_sound_.assign(std::size_t(across) * across, false);
    for (int i = 0; i < (across + 1) * (across + 1); ++i) {
        if (!seen[i].sound) continue;
        const int x = i % (across + 1), y = i / (across + 1);
        for (int v = std::max(y - 2, 0); v < std::min(y + 2, across); ++v)
            for (int u = std::max(x - 2, 0); u < std::min(x + 2, across); ++u) near_sound_[v * across + u] = true;
    }
}

/// Adds a draft unless all rays in and around it are lost.
void GhostMapMaker::propose(const Draft& d, std::vector<Draft>& to) const {
    constexpr int across = GhostMap::kFirstAcross << kSoundLevel;
    const int x = int(d.low.x * across), y = int(d.low.y * across), size = std::max(int(d.size * across), 1);
    for (int v = y; v < y + size; ++v)
        for (int u = x; u < x + size; ++u)
            if (near_sound_[v * across + u]) return to.push_back(d);
}

void GhostMapMaker::look(const Draft& d, Rays& rays) const {
    const float nm = lambda_node(kMiddle);
    for (int n = 0; n < GhostMap::kNodes; ++n) rays.push_back({at(d, node_at(n)), {0, 0}, nm});
    for (const Vec2f u : kTestAt) rays.push_back({at(d, u), {0, 0}, nm});
    for (const Vec2f rim : {Vec2f{1, 0}, Vec2f{0, 1}}) rays.push_back({at(d, node_at(kRimNode)), rim, nm});
}

void GhostMapMaker::divide(const Draft& d, std::vector<Draft>& next) {
    if (d.level + 1 == GhostMap::kLevels) return give_up(d);
    const float half = 0.5f * d.size;
    for (int k = 0; k < 4; ++k)
        propose({{d.low.x + float(k % 2) * half, d.low.y + float(k / 2) * half}, half, d.level + 1}, next);
}

void GhostMapMaker::sort() {
    const auto middle = [](const GhostMap::Cell& c) { return GhostMap::code(c.low + Vec2f{0.01f, 0.01f} * c.size); };
    std::ranges::sort(map_.cells_, {}, middle);
    for (const GhostMap::Cell& c : map_.cells_) map_.codes_.push_back(middle(c));
}

GhostMap::GhostMap(const MapRays& rays, const Sensor& sensor, float reach, const Accuracy& accuracy) {
    GhostMapMaker(*this, rays, sensor, reach, accuracy).make();
}

}  // namespace dg
