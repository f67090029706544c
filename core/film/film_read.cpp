// film_read.cpp -- what is read from the exact sums: means, variance, auxiliary values,
// bad samples.
//
// Variance of the mean of n samples s: (sum s^2 - (sum s)^2 / n) / (n (n - 1)), which
// takes samples as independent; stratified ones scatter less, so it errs on the safe
// side. A splat adds its value and its square but no count: the pixel then is a sum of
// independent arrivals (compound Poisson), whose variance is the expected sum of squares.
// The formula takes the square of the mean off those too: it is too low by at most
// mean^2 / n, little where samples scatter by more than their mean. Splats of one camera
// sample in one pixel would be correlated: the caller adds them up first.
#include <algorithm>
#include <cmath>

#include "film/film.h"
#include "math/error.h"

namespace dg {

Vec3d Film::sum_xyz(std::size_t i) const {
    Vec3d sum;
    for (int k = 0; k < 3; ++k) {
        ValueSum all = pixels_[i].xyz[k];
        if (layout_.splats) all.add(splats_[i].xyz[k]);
        if (layout_.flare) all.add(flare_[i].xyz[k]);
        sum[k] = all.value();
    }
    return sum;
}

std::vector<float> Film::mean_xyz() const {
    std::vector<float> mean;
    mean.reserve(3 * pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Vec3d sum = sum_xyz(i);
        const std::uint32_t n = pixels_[i].count;
        for (int k = 0; k < 3; ++k) mean.push_back(n ? float(sum[k] / n) : 0.f);
    }
    return mean;
}

std::vector<float> Film::layer_xyz(Layer layer) const {
    const std::vector<Sums>& sums = layer == Layer::splats ? splats_ : flare_;
    if (sums.empty())
        throw Error(std::string("film: this film was made without a layer of ") +
                    (layer == Layer::splats ? "light paths" : "flare"));
    std::vector<float> mean;
    mean.reserve(3 * pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        for (const ValueSum& sum : sums[i].xyz)
            mean.push_back(pixels_[i].count ? float(sum.value() / pixels_[i].count) : 0.f);
    return mean;
}

std::vector<float> Film::half_xyz(Half half, bool by_light_paths) const {
    if (halves_.empty()) throw Error("film: this film was made without halves");
    std::vector<float> mean(3 * pixels_.size());
    if (by_light_paths && splats_.empty()) return mean;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const HalfPixel& even = halves_[i];
        const std::uint32_t n = half == Half::even ? even.count : pixels_[i].count - even.count;
        const ValueSum* const part = by_light_paths ? even.splats : even.own;
        const ValueSum* const all = by_light_paths ? splats_[i].xyz : pixels_[i].xyz;
        for (int k = 0; k < 3 && n; ++k)
            mean[3 * i + k] =
                float((half == Half::even ? part[k].value() : all[k].value() - part[k].value()) / n);
    }
    return mean;
}

std::vector<float> Film::coverage() const {
    if (coverage_.empty()) throw Error("film: this film was made without coverage");
    std::vector<float> shares;
    shares.reserve(coverage_.size());
    for (const CoveragePixel& p : coverage_) shares.push_back(p.white > 0 ? float(double(p.covered) / double(p.white)) : 0.f);
    return shares;
}

Ranked Film::ranked(std::span<const std::uint32_t> ids, int ranks) const {
    if (!objects_) throw Error("film: this film was made without objects");
    if (ranks < 1) throw input_error("film", "ranks", "at least 1", std::to_string(ranks));
    Ranked found;
    found.ids.resize(std::size_t(ranks) * pixels_.size());
    found.shares.resize(found.ids.size());
    std::vector<CoverLists::Entry> groups;   // of a pixel
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (coverage_[i].white <= 0) continue;
        groups.clear();
        for (const CoverLists::Entry& e : objects_->of(i)) {
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
        double left = 0;
        for (std::size_t k = 0; k < groups.size(); ++k) {
            const double share = double(groups[k].steps) / double(coverage_[i].white);
            if (k < kept) found.ids[ranks * i + k] = groups[k].object, found.shares[ranks * i + k] = float(share);
            else left += share;
        }
        found.cut_pixels += kept < groups.size();
        found.most_cut = std::max(found.most_cut, float(std::abs(left)));
    }
    return found;
}

std::vector<float> Film::set_xyz(bool with_objects) const {
    if (catchers_.empty()) throw Error("film: this film was made without catchers");
    std::vector<float> mean;
    mean.reserve(3 * pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        for (const ValueSum& sum : with_objects ? catchers_[i].with : catchers_[i].without)
            mean.push_back(pixels_[i].count ? float(sum.value() / pixels_[i].count) : 0.f);
    return mean;
}

std::vector<float> Film::set_channels(bool with_objects) const {
    if (catcher_channels_.empty()) throw Error("film: this film was made without catchers, or without channels");
    std::vector<float> mean;
    mean.reserve(channels_.size());
    const std::size_t channels = layout_.channels;
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        for (std::size_t c = 0; c < channels; ++c) {
            const ValueSum& sum = catcher_channels_[(2 * i + (with_objects ? 0 : 1)) * channels + c];
            mean.push_back(pixels_[i].count ? float(sum.value() / pixels_[i].count) : 0.f);
        }
    return mean;
}

std::vector<float> Film::mean_bands() const {
    if (bands_.empty()) throw Error("film: this film was made without bands");
    return means(bands_, layout_.bands);
}

std::vector<float> Film::mean_channels() const {
    if (channels_.empty()) throw Error("film: this film was made without channels of a sensor");
    if (channel_splats_.empty()) return means(channels_, layout_.channels);
    std::vector<ValueSum> all = channels_;
    for (std::size_t i = 0; i < all.size(); ++i) all[i].add(channel_splats_[i]);
    return means(all, layout_.channels);
}

std::vector<float> Film::means(const std::vector<ValueSum>& sums, int each) const {
    std::vector<float> mean;
    mean.reserve(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::uint32_t n = pixels_[i / each].count;
        mean.push_back(n ? float(sums[i].value() / n) : 0.f);
    }
    return mean;
}

Film::Estimate Film::estimate(std::size_t i) const {
    const Pixel& p = pixels_[i];
    Vec3d xyz{p.xyz[0].value(), p.xyz[1].value(), p.xyz[2].value()}, all = sum_xyz(i);
    for (int k = 0; k < 3 && layout_.catchers; ++k) {   // the noise of light and change, beside what is seen
        const double with = catchers_[i].with[k].value();
        xyz[k] += with - catchers_[i].without[k].value();
        all[k] += with;
    }
    const double n = p.count;
    Estimate e;
    for (int k = 0; k < 3; ++k) {
        const double own = dot(to_double(rgb_from_xyz_[k]), xyz);
        e.sum[k] = dot(to_double(rgb_from_xyz_[k]), all);
        const double scatter = p.rgb_squares[k].value() - own * own / n;
        e.variance[k] = n < 2 ? 0 : std::max(0.0, scatter / (n * (n - 1)));
        if (layout_.splats && n > 0) e.variance[k] += splats_[i].rgb_squares[k].value() / (n * n);
        if (layout_.flare && n > 0) e.variance[k] += flare_[i].rgb_squares[k].value() / (n * n);
    }
    return e;
}

std::vector<float> Film::variance_rgb() const {
    std::vector<float> variance;
    variance.reserve(3 * pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Estimate e = estimate(i);
        for (double v : e.variance) variance.push_back(float(v));
    }
    return variance;
}

std::vector<float> Film::relative_variance(float dark) const {
    std::vector<float> relative;
    relative.reserve(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Estimate e = estimate(i);
        const double n = std::max(1u, pixels_[i].count);
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            sum += e.variance[k] / (e.sum[k] * e.sum[k] / (n * n) + dark);
        relative.push_back(float(sum * n / 3));
    }
    return relative;
}

std::vector<std::uint32_t> Film::sample_counts() const {
    std::vector<std::uint32_t> counts;
    counts.reserve(pixels_.size());
    for (const Pixel& p : pixels_) counts.push_back(p.count);
    return counts;
}

const std::vector<Film::AovPixel>& Film::require_aovs() const {
    if (!layout_.aovs) throw Error("film: this film was made without aovs");
    return aovs_;
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
    mean.reserve(pixels_.size());
    for (const AovPixel& p : require_aovs()) {
        const std::uint32_t n = found->of_hits ? p.hits : p.passed;
        mean.push_back(n ? float(p.sums[k].value() / n) : 0.f);
    }
    return mean;
}

std::vector<std::uint32_t> Film::object_ids() const {
    std::vector<std::uint32_t> ids;
    ids.reserve(pixels_.size());
    for (const AovPixel& p : require_aovs()) ids.push_back(p.object_id);
    return ids;
}

std::vector<BadSample> Film::bad_samples() const {
    std::vector<BadSample> bad;
    for (std::size_t i = 0; i < pixels_.size() && bad.size() < 100; ++i)
        if (pixels_[i].bad)
            bad.push_back({layout_.offset_x + int(i % layout_.width),
                           layout_.offset_y + int(i / layout_.width),
                           pixels_[i].first_bad});
    return bad;
}

std::uint64_t Film::bad_sample_count() const {
    std::uint64_t count = 0;
    for (const Pixel& p : pixels_) count += p.bad;
    return count;
}

}  // namespace dg
