// film_read.cpp -- pictures out of exact sums: means, auxiliary values, objects, bad samples.
#include <algorithm>
#include <cmath>

#include "film/film.h"
#include "math/error.h"

namespace dg {

template <Layer kLayer>
const auto& Film::require() const {
    if (of<kLayer>().empty()) Stores::with(stores_, std::get<std::size_t(kLayer)>(kLayers).name, [](auto&, auto&) {});
    return of<kLayer>();
}

Vec3d Film::sum_xyz(std::size_t i) const {
    Vec3d sum;
    for (int k = 0; k < 3; ++k) {
        ValueSum all = of<Layer::sums>()[i].xyz[k];
        for (const Plane<ColorSums>* emitter_layer : {&of<Layer::splats>(), &of<Layer::flare>()})
            if (!emitter_layer->empty()) all.add((*emitter_layer)[i].xyz[k]);
        sum[k] = all.value();
    }
    return sum;
}

std::vector<float> Film::mean_xyz() const {
    std::vector<float> mean;
    mean.reserve(3 * layout_.pixels());
    for (std::size_t i = 0; i < layout_.pixels(); ++i) {
        const Vec3d sum = sum_xyz(i);
        const std::uint32_t n = of<Layer::sums>()[i].count;
        for (int k = 0; k < 3; ++k) mean.push_back(n ? float(sum[k] / n) : 0.f);
    }
    return mean;
}

std::vector<float> Film::means(const std::string& layer, std::size_t first, std::size_t count) const {
    std::vector<float> mean;
    const auto read = [&]<HasMeans R>(const Plane<R>& plane) {
        const std::size_t of_record = R().values().size(), pixels = layout_.pixels();
        const std::size_t records = plane.size() / pixels, last = std::min(records * of_record, first + count);
        DG_CHECK(first, <, last);
        mean.reserve((last - first) * pixels);
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t k = first; k < last; ++k) {
                const ValueSum& sum = plane[records * i + k / of_record].values()[k % of_record];
                const std::uint32_t n = of<Layer::sums>()[i].count;
                mean.push_back(n ? float(sum.value() / n) : 0.f);
            }
    };
    Stores::with(stores_, layer, [&](const auto&, const auto& store) {
        if constexpr (requires { read(store); }) read(store);
        else throw input_error("film", "means", "a layer of plain sums", layer);
    });
    return mean;
}

std::vector<float> Film::mean_channels() const {
    const Plane<ValueSum>& own = require<Layer::channels>();
    const Plane<ValueSum>& splats = of<Layer::channel_splats>();
    const std::size_t channels = own.size() / layout_.pixels();
    std::vector<float> mean;
    mean.reserve(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        ValueSum sum = own[i];
        if (!splats.empty()) sum.add(splats[i]);
        const std::uint32_t n = of<Layer::sums>()[i / channels].count;
        mean.push_back(n ? float(sum.value() / n) : 0.f);
    }
    return mean;
}

std::vector<float> Film::half_xyz(Half half, bool by_light_paths) const {
    const Plane<HalfSums>& halves = require<Layer::halves>();
    const Plane<CameraSums>& pixels = of<Layer::sums>();
    const Plane<ColorSums>& splats = of<Layer::splats>();
    std::vector<float> mean(3 * layout_.pixels());
    if (by_light_paths && splats.empty()) return mean;
    for (std::size_t i = 0; i < layout_.pixels(); ++i) {
        const HalfSums& even = halves[i];
        const std::uint32_t n = half == Half::even ? even.count : pixels[i].count - even.count;
        const ValueSum* const part = by_light_paths ? even.splats : even.own;
        const ValueSum* const all = by_light_paths ? splats[i].xyz : pixels[i].xyz;
        for (int k = 0; k < 3 && n; ++k)
            mean[3 * i + k] =
                float((half == Half::even ? part[k].value() : all[k].value() - part[k].value()) / n);
    }
    return mean;
}

std::vector<float> Film::coverage() const {
    std::vector<float> shares;
    shares.reserve(layout_.pixels());
    for (const CoverageSums& p : require<Layer::coverage>())
        shares.push_back(p.white > 0 ? float(double(p.covered) / double(p.white)) : 0.f);
    return shares;
}

Ranked Film::ranked(std::span<const std::uint32_t> ids, int ranks) const {
    const CoverLists& objects = *require<Layer::objects>();
    const Plane<CoverageSums>& cover = of<Layer::coverage>();
    if (ranks < 1) throw input_error("film", "ranks", "at least 1", std::to_string(ranks));
    Ranked found;
    found.ids.resize(std::size_t(ranks) * layout_.pixels());
    found.shares.resize(found.ids.size());
    std::vector<CoverLists::Entry> groups;   // of a pixel
    for (std::size_t i = 0; i < layout_.pixels(); ++i) {
        if (cover[i].white <= 0) continue;
        groups.clear();
        for (const CoverLists::Entry& e : objects.of(i)) {
            if (e.object >= ids.size()) continue;
            const auto known = std::ranges::find(groups, ids[e.object], &CoverLists::Entry::object);
            if (known == groups.end()) groups.push_back({ids[e.object], e.steps});
            else known->steps += e.steps;
        }
        const auto size = [](const CoverLists::Entry& e) { return std::abs(double(e.steps)); };
        std::ranges::sort(groups, [&](const auto& a, const auto& b) {
            return size(a) != size(b) ? size(a) > size(b) : a.object < b.object;
        });
        const std::size_t kept = std::min(groups.size(), std::size_t(ranks));
        double rest = 0;
        for (std::size_t k = 0; k < groups.size(); ++k) {
            const double share = double(groups[k].steps) / double(cover[i].white);
            if (k < kept) found.ids[ranks * i + k] = groups[k].object, found.shares[ranks * i + k] = float(share);
            else rest += share;
        }
        found.cut_pixels += kept < groups.size();
        found.most_cut = std::max(found.most_cut, float(std::abs(rest)));
    }
    return found;
}

std::vector<std::uint32_t> Film::sample_counts() const {
    std::vector<std::uint32_t> counts;
    counts.reserve(layout_.pixels());
    for (const CameraSums& p : of<Layer::sums>()) counts.push_back(p.count);
    return counts;
}

std::vector<float> Film::aov(const std::string& name) const {
    const auto found = std::ranges::find(kAovChannels, name, &AovChannel::name);
    if (found == kAovChannels.end()) {
        std::string known;
        for (const AovChannel& c : kAovChannels) known += (known.empty() ? "" : ", ") + std::string(c.name);
        throw input_error("film", "aov", "one of " + known, name);
    }
    const auto k = std::size_t(found - kAovChannels.begin());
    std::vector<float> mean;
    mean.reserve(layout_.pixels());
    for (const AovSums& p : require<Layer::aovs>()) {
        const std::uint32_t n = found->of_hits ? p.hits : p.passed;
        mean.push_back(n ? float(p.sums[k].value() / n) : 0.f);
    }
    return mean;
}

std::vector<std::uint32_t> Film::object_ids() const {
    std::vector<std::uint32_t> ids;
    ids.reserve(layout_.pixels());
    for (const AovSums& p : require<Layer::aovs>()) ids.push_back(p.object_id);
    return ids;
}

std::vector<BadSample> Film::bad_samples() const {
    const Plane<CameraSums>& pixels = of<Layer::sums>();
    std::vector<BadSample> bad;
    for (std::size_t i = 0; i < pixels.size() && bad.size() < 100; ++i)
        if (pixels[i].bad)
            bad.push_back({layout_.offset_x + int(i % layout_.width), layout_.offset_y + int(i / layout_.width),
                           pixels[i].first_bad});
    return bad;
}

std::uint64_t Film::bad_sample_count() const {
    std::uint64_t count = 0;
    for (const CameraSums& p : of<Layer::sums>()) count += p.bad;
    return count;
}

}  // namespace dg
