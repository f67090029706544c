// ghost_map_fill.cpp -- computes the values of a map cell and tests them between its nodes.
#include <algorithm>
#include <cmath>

#include "render/flare/maps/color_table.h"
#include "render/flare/maps/ghost_map_maker.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

/// Tests at the center of a cell, between the nodes of the wavelength and off the axes of the source, where the map is
/// linear. The tolerance of the source's image is larger there by this factor.
constexpr int kOffs = 3;
constexpr struct {
    Vec2f shift;
    float nm, slack;
} kOff[kOffs] = {{{0, 0}, 430, 1}, {{0, 0}, 670, 1}, {{0.6f, -0.6f}, 500, 2}};
/// Points of the source around its center, for second-order terms.
constexpr int kStar = 7;
constexpr float kAside = 0.7f;
constexpr Vec2f kStarAt[kStar] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {kAside, kAside}, {kAside, -kAside}};
/// Wavelengths at which light is tested off the cell's center.
constexpr int kColors = 6;
constexpr float kColorNm[kColors] = {430, 465, 510, 550, 590, 640};
constexpr int kCornerNodes[4] = {0, 3, 12, 15};

}  // namespace

// Rays for: other wavelengths, the source's axes, tests off all axes, spectra at the center and at corners, the star,
// colours.
const int GhostMapMaker::kMore =
    GhostMap::kNodes * (GhostMap::kSets - 1) + kOffs + GhostMap::kFineSpectrum + 4 * GhostMap::kSpectrum + kStar +
    kTests * kColors;

void GhostMapMaker::complete(const Draft& d, Rays& rays) const {
    const float middle = lambda_node(kMiddle);
    const auto nodes = [&](Vec2f shift, float nm) {
        for (int n = 0; n < GhostMap::kNodes; ++n) {
            const Vec2f u{float(n % GhostMap::kSide), float(n / GhostMap::kSide)};
            rays.push_back({at(d, u * (1 / 3.f)), shift, nm});
        }
    };
    nodes({0, 0}, lambda_node(0)), nodes({0, 0}, lambda_node(2));
    nodes({1, 0}, middle), nodes({0, 1}, middle);
    for (int t = 0; t < kOffs; ++t) rays.push_back({at(d, {0.5f, 0.5f}), kOff[t].shift, kOff[t].nm});
    for (int k = 0; k < GhostMap::kFineSpectrum; ++k)
        rays.push_back({at(d, {0.5f, 0.5f}), {0, 0}, spectrum_node(float(k) / GhostMap::kFine)});
    for (int c = 0; c < 4; ++c)
        for (int k = 0; k < GhostMap::kSpectrum; ++k)
            rays.push_back({at(d, {float(c % 2), float(c / 2)}), {0, 0}, spectrum_node(float(k))});
    for (const Vec2f shift : kStarAt) rays.push_back({at(d, {0.5f, 0.5f}), shift, middle});
    for (const Vec2f u : kTestAt)
        for (const float nm : kColorNm) rays.push_back({at(d, u), {0, 0}, nm});
}

/// Adds a cell; false if it is not smooth over wavelengths and the source.
bool GhostMapMaker::add(const Draft& d, const MapLanding* seen, const MapLanding* more, const CellBlur& blur) {
    constexpr int kOffTests = 4 * GhostMap::kNodes;   // index
    if (!std::all_of(more, more + 2 * GhostMap::kNodes, [](const MapLanding& l) { return l.sound; })) return false;
    const MapLanding *const fine = more + kOffTests + kOffs, *const corners = fine + GhostMap::kFineSpectrum;
    GhostMap::Cell cell{d.low, d.size, std::uint32_t(map_.values_.size()), false, blur};
    add_nodes(seen, more), add_spectra(seen, fine, corners), add_bends(corners + 4 * GhostMap::kSpectrum);
    Scale scale{{}, {}, {}, blur, 0, 1};
    for (int i = 0; i < GhostMap::kNodes; ++i)
        scale.beyond.add(seen[i].beyond), scale.x.add(seen[i].px.x), scale.y.add(seen[i].px.y);
    for (int k = 0; k < GhostMap::kFineSpectrum; ++k) scale.light += fine[k].pass / GhostMap::kFineSpectrum;
    const Landings off = in_middle(cell);
    bool good = colors_agree(cell, corners + 4 * GhostMap::kSpectrum + kStar);
    for (int t = 0; t < kOffs; ++t) scale.slack = kOff[t].slack, good = good && agree(off[t], more[kOffTests + t], scale);
    good ? map_.cells_.push_back(cell) : map_.values_.resize(cell.data);
    return good;
}

/// Compares visible light at each test, over its wavelengths, relative to the exact light there and at the center.
bool GhostMapMaker::colors_agree(const GhostMap::Cell& cell, const MapLanding* exact) {
    constexpr int kAll = kTests * kColors;
    for (int i = 0; i < kAll; ++i) batch_.set(i, kTestAt[i / kColors], {0, 0}, kColorNm[i % kColors], 1);
    for (int i = 0; i < kColors; ++i) batch_.set(kAll + i, {0.5f, 0.5f}, {0, 0}, kColorNm[i], 1);
    map_.landings(cell, batch_, kAll + kColors);
    float middle = 0;
    for (int i = kAll; i < kAll + kColors; ++i) middle += seen_light(batch_.nm[i]) * batch_.glass[i];
    for (int t = 0; t < kTests; ++t) {
        float wrong = 0, all = middle;
        for (int i = t * kColors; i < (t + 1) * kColors; ++i) {
            if (!exact[i].sound) continue;
            const float seen = seen_light(batch_.nm[i]);
            wrong += seen * std::abs(batch_.glass[i] - exact[i].pass), all += seen * exact[i].pass;
        }
        if (wrong > accuracy_.color * all) return false;
    }
    return true;
}

/// Adds the fields of the wavelengths, and their differences along the axes of the source, which are 0 where rays from
/// its rim are lost.
void GhostMapMaker::add_nodes(const MapLanding* seen, const MapLanding* more) {
    std::vector<float>& values = map_.values_;
    const auto put = [&](const MapLanding& l, const MapLanding* from) {
        const MapLanding& own = !from || l.sound ? l : *from;
        const auto value = [&](auto of) { values.push_back(of(own) - (from ? of(*from) : 0)); };
        value([](const MapLanding& m) { return m.px.x; }), value([](const MapLanding& m) { return m.px.y; });
        value([](const MapLanding& m) { return m.beyond; });
        for (int k = 0; k < map_.crossings_; ++k)
            value([k](const MapLanding& m) { return m.iris[k].x; }),
                value([k](const MapLanding& m) { return m.iris[k].y; });
    };
    constexpr int kAxes = 2 * GhostMap::kNodes;   // index
    for (int n = 0; n < GhostMap::kNodes; ++n) {
        put(more[n], nullptr), put(seen[n], nullptr), put(more[GhostMap::kNodes + n], nullptr);
        put(more[kAxes + n], &seen[n]), put(more[kAxes + GhostMap::kNodes + n], &seen[n]);
        values.push_back(seen[n].pass);
    }
}

/// Adds transmittances at the center relative to the middle wavelength, and their differences at the corners.
void GhostMapMaker::add_spectra(const MapLanding* seen, const MapLanding* fine, const MapLanding* corners) {
    const float place = spectrum_place(lambda_node(kMiddle)) * GhostMap::kFine;
    const int below = int(place);
    const float center = fine[below].pass + (place - float(below)) * (fine[below + 1].pass - fine[below].pass);
    const auto relative = [&](int k) { return center > 0 ? fine[k].pass / center : 0; };
    for (int k = 0; k < GhostMap::kFineSpectrum; ++k) map_.values_.push_back(relative(k));
    for (int c = 0; c < 4; ++c)
        for (int k = 0; k < GhostMap::kSpectrum; ++k)
            map_.values_.push_back(corners[c * GhostMap::kSpectrum + k].pass -
                                   relative(k * GhostMap::kFine) * seen[kCornerNodes[c]].pass);
}

/// Adds second differences over the source, which are 0 where rays are lost.
void GhostMapMaker::add_bends(const MapLanding* star) {
    const bool sound = std::all_of(star, star + kStar, [](const MapLanding& l) { return l.sound; });
    const auto add = [&](const auto& bend) {
        const auto put = [&](const auto& value) { map_.values_.push_back(sound ? bend(value) : 0); };
        put([](const MapLanding& l) { return l.px.x; }), put([](const MapLanding& l) { return l.px.y; });
        put([](const MapLanding& l) { return l.beyond; });
        for (int k = 0; k < map_.crossings_; ++k)
            put([k](const MapLanding& l) { return l.iris[k].x; }), put([k](const MapLanding& l) { return l.iris[k].y; });
    };
    add([&](const auto& f) { return 0.5f * (f(star[1]) + f(star[2])) - f(star[0]); });
    add([&](const auto& f) { return 0.5f * (f(star[3]) + f(star[4])) - f(star[0]); });
    add([&](const auto& f) {
        return (f(star[5]) - f(star[6]) - kAside * (f(star[3]) - f(star[4]))) / (2 * kAside * kAside);
    });
}

GhostMapMaker::Landings GhostMapMaker::in_middle(const GhostMap::Cell& cell) {
    for (int t = 0; t < kOffs; ++t) batch_.set(t, {0.5f, 0.5f}, kOff[t].shift, kOff[t].nm, 1);
    map_.landings(cell, batch_, kOffs);
    Landings landings;
    for (int t = 0; t < kOffs; ++t) landings.push_back(batch_.landing(t, map_.crossings_));
    return landings;
}

}  // namespace dg
