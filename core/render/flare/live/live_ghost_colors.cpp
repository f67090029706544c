// live_ghost_colors.cpp -- dependence of a ghost on wavelength and source point, at a subset of its grid's nodes.
#include <algorithm>

#include "render/flare/live/live_ghost.h"
#include "render/flare/live/node_fill.h"
#include "render/flare/maps/ghost_map_nodes.h"

namespace dg {
namespace {

constexpr int kWaves = LiveSource::kNodes;
constexpr float kAlike = 0.1f;     // relative error of transmittance that is accepted from the cache
constexpr float kOutside = 0.2f;   // clip value beyond which cached spectra are not used

}  // namespace

/// The sound node nearest to a coarse node, preferably lit or almost lit; empty if there is none in its neighbourhood.
std::optional<int> LiveGhost::sound_near(int few) const {
    std::optional<int> best;
    int least = 1 << 20;
    const int x = few % few_side_ * step_, y = few / few_side_ * step_;
    for (int v = std::max(y - step_, 0); v <= std::min(y + step_, kSide - 1); ++v)
        for (int u = std::max(x - step_, 0); u <= std::min(x + step_, kSide - 1); ++u) {
            const MapLanding& l = node(u, v);
            const int far = (u - x) * (u - x) + (v - y) * (v - y) + (l.beyond < kOutside ? 0 : step_ * step_);
            if (l.sound && far < least) best = v * kSide + u, least = far;
        }
    return best;
}

/// Whether a neighbouring square sends light.
bool LiveGhost::matters(int few) const {
    const int x = 2 * (few % few_side_) * step_, y = 2 * (few / few_side_) * step_;
    return std::ranges::any_of(squares_, [&](const Square& s) {
        return std::abs(2 * s.x + 1 - x) <= 2 * step_ && std::abs(2 * s.y + 1 - y) <= 2 * step_;
    });
}

LiveGhost::FewNodes LiveGhost::few_nodes() const {
    FewNodes nodes;
    for (int n = 0; n < int(few_.size()); ++n)
        if (const auto own = sound_near(n); own && matters(n)) nodes.few.push_back(n), nodes.node.push_back(*own);
    return nodes;
}

/// Spectra at nodes of the grid: cached, or by rays if there is no cache or if it disagrees with the grid's ray.
std::vector<GhostPlace::Spectrum> LiveGhost::spectra(const std::vector<int>& nodes) {
    std::vector<GhostPlace::Spectrum> found(nodes.size());
    std::vector<MapRay> rays;
    std::vector<int> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec2f at = place_of(nodes[i]);
        if (known_) {
            found[i] = known_->spectrum(at);
            const float pass = grid_.nodes[std::size_t(nodes[i])].pass;
            if (std::abs(source_.change(found[i]).pass - pass) < kAlike * pass) continue;
        }
        for (int k = 0; k < kWaves; ++k) rays.push_back({at, {0, 0}, LiveSource::node_nm(k)}), of.push_back(int(i));
    }
    const std::vector<MapLanding> landings = trace(rays);
    for (std::size_t i = 0; i < landings.size(); ++i) {
        const MapLanding& own = grid_.nodes[std::size_t(nodes[std::size_t(of[i])])];
        found[std::size_t(of[i])][i % kWaves] = landings[i].sound ? landings[i].pass : own.pass;
    }
    return found;
}

void LiveGhost::set_spectra(const FewNodes& nodes) {
    const std::vector<GhostPlace::Spectrum> found = spectra(nodes.node);
    for (std::size_t i = 0; i < found.size(); ++i) few_[nodes.few[i]].spectrum = found[i];
}

/// Traces the dependence on wavelength and source point.
void LiveGhost::trace_sets(const FewNodes& nodes) {
    const int crossings = rays_.crossings();
    std::vector<MapRay> rays;
    for (const int n : nodes.node) {
        const Vec2f at = place_of(n);
        rays.push_back({at, {0, 0}, lambda_node(0)}), rays.push_back({at, {0, 0}, lambda_node(2)});
        rays.push_back({at, {1, 0}, GhostGrid::middle_nm()}), rays.push_back({at, {0, 1}, GhostGrid::middle_nm()});
    }
    const std::vector<MapLanding> landings = trace(rays);
    for (std::size_t i = 0; i < nodes.few.size(); ++i) {
        Few& f = few_[nodes.few[i]];
        const MapLanding& own = grid_.nodes[std::size_t(nodes.node[i])];
        for (int k = 0; k < MeshPatch::kSets; ++k) {
            const MapLanding& l = landings[i * MeshPatch::kSets + k];
            if (!l.sound) continue;
            std::array<float, MeshPatch::kMostFields> from{}, to{};
            put_fields(from.data(), 1, own, crossings), put_fields(to.data(), 1, l, crossings);
            for (int j = 0; j < 3 + 2 * crossings; ++j) f.sets[k][j] = to[j] - from[j];
        }
    }
}

void LiveGhost::fill_few(const FewNodes& nodes) {
    std::vector<bool> sound(few_.size());
    for (const int n : nodes.few) few_[n].sound = sound[n] = true;
    fill_from_beside(sound, few_side_, [&](int n, const std::vector<int>& beside) {
        const float w = 1 / float(beside.size());
        for (const int m : beside) {
            for (int k = 0; k < MeshPatch::kSets; ++k)
                for (int j = 0; j < MeshPatch::kMostFields; ++j) few_[n].sets[k][j] += w * few_[m].sets[k][j];
            for (int k = 0; k < kWaves; ++k) few_[n].spectrum[k] += w * few_[m].spectrum[k];
        }
    });
}

LiveGhost::Few LiveGhost::few_at(Vec2f node) const {
    const float x = node.x / float(step_), y = node.y / float(step_);
    const int u = std::min(int(x), few_side_ - 2), v = std::min(int(y), few_side_ - 2);
    const float fx = x - float(u), fy = y - float(v);
    Few sum;
    for (int k = 0; k < 4; ++k) {
        const float w = (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy);
        const Few& f = few_[(v + (k >> 1)) * few_side_ + u + (k & 1)];
        for (int s = 0; s < MeshPatch::kSets; ++s)
            for (int j = 0; j < MeshPatch::kMostFields; ++j) sum.sets[s][j] += w * f.sets[s][j];
        for (int b = 0; b < kWaves; ++b) sum.spectrum[b] += w * f.spectrum[b];
    }
    return sum;
}

/// Computes the blur of edges and light at the coarse nodes.
void LiveGhost::find_blur() {
    std::vector<SheetSmooth::CellLight> cells;
    for (int n = 0; n < int(few_.size()); ++n) {
        if (!few_[n].sound) continue;
        const int x = std::clamp(n % few_side_ * step_ - 1, 0, kSide - 4);
        const int y = std::clamp(n / few_side_ * step_ - 1, 0, kSide - 4);
        std::array<MapLanding, 16> nodes;
        for (int k = 0; k < 16; ++k) nodes[k] = node(x + k % 4, y + k / 4);
        std::array<MapLanding, 2> rim;
        for (int r = 0; r < 2; ++r) {
            const auto& set = few_[n].sets[MeshPatch::kAcross + r];
            rim[r] = nodes[kRimNode];
            rim[r].px = rim[r].px + Vec2f{set[0], set[1]}, rim[r].beyond += set[2];
            for (int k = 0; k < rays_.crossings(); ++k)
                rim[r].iris[k] = rim[r].iris[k] + Vec2f{set[3 + 2 * k], set[4 + 2 * k]};
        }
        if (!std::ranges::all_of(nodes, &MapLanding::sound)) continue;
        few_[n].blurs = true;
        const GhostLens& ghosts = rays_.ghosts();
        few_[n].blur = cell_blur({nodes.data(), rim.data(), rays_.crossings()}, ghosts.iris(), ghosts.iris_radius());
    }
    for (Square& s : squares_) {
        s.blur = blur_near(s);
        if (s.light > 0) cells.push_back({&s.blur, s.light});
    }
    smooth_ = SheetSmooth::of(cells);
}

/// The blur at the nearest coarse node that has a blur.
const CellBlur& LiveGhost::blur_near(const Square& s) const {
    static const CellBlur sharp{};
    const CellBlur* best = &sharp;
    int least = 1 << 20;
    for (int n = 0; n < int(few_.size()); ++n) {
        const int x = 2 * (n % few_side_) * step_ - 2 * s.x - 1, y = 2 * (n / few_side_) * step_ - 2 * s.y - 1;
        if (few_[n].blurs && x * x + y * y < least) least = x * x + y * y, best = &few_[n].blur;
    }
    return *best;
}

}  // namespace dg
