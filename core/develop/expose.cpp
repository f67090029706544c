#include "develop/expose.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "develop/poisson.h"
#include "math/error.h"

namespace dg {
namespace {

constexpr int kBlock = 32;   // rows; crosstalk reads one more row on each side
constexpr double kMostLowPass = 1000;   // px
enum Use { kShot, kPattern };

struct Tap {
    int dx, dy;
    float weight;
};

/// Taps in whole pixels of the low-pass filter's two images: along one axis, or along both.
std::vector<Tap> low_pass_taps(double distance_px) {
    if (distance_px == 0) return {{0, 0, 1.f}};
    const double half = distance_px / 2;
    const int near = int(std::floor(half));
    const float far_share = float(half - near);
    std::vector<Tap> line;
    if (near == 0) line.push_back({0, 0, 1 - far_share});   // both images
    for (const int sign : {-1, 1}) {
        if (near > 0) line.push_back({sign * near, 0, 0.5f * (1 - far_share)});
        if (far_share > 0) line.push_back({sign * (near + 1), 0, 0.5f * far_share});
    }
    std::vector<Tap> taps;
    for (const Tap& x : line)
        for (const Tap& y : line) taps.push_back({x.dx, y.dx, x.weight * y.weight});
    return taps;
}

/// Index mirrored at the edges of the image.
int mirrored(int i, int size) {
    while (i < 0 || i >= size) i = i < 0 ? -1 - i : 2 * size - 1 - i;
    return i;
}

float dot(const float* a, const float* b, int count) {
    if (count == 3) return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    float sum = 0;
    for (int i = 0; i < count; ++i) sum += a[i] * b[i];
    return sum;
}

/// Counters; the first bad photosite does not depend on thread order.
struct Counts {
    std::atomic<std::int64_t> negative{0}, bad{0};
    std::atomic<std::int64_t> first_bad{std::numeric_limits<std::int64_t>::max()};

    void add(std::int64_t negatives, std::int64_t bads, std::int64_t first) {
        negative += negatives;
        bad += bads;
        std::int64_t known = first_bad.load();
        while (first < known && !first_bad.compare_exchange_weak(known, first)) {
        }
    }
};

class Exposing {
public:
    Exposing(const Planes& light, const Shot& shot, Exposed& out)
        : light_(light), shot_(shot), out_(out), taps_(low_pass_taps(shot.low_pass_px)) {}

    /// Exposes rows [begin, end).
    void rows(int begin, int end) {
        each(begin, end, [&](int x, int y, float mean, const Keys& keys) { read(x, y, mean, keys); });
    }

    /// Expected electrons of rows [begin, end).
    void expected_rows(int begin, int end, std::vector<float>& out) {
        each(begin, end, [&](int x, int y, float mean, const Keys& keys) {
            out[std::size_t(y) * light_.width + x] = mean * float(pattern(x, keys.pattern).response);
        });
    }

    Counts counts;

private:
    struct Keys {
        std::uint64_t shot, pattern;
    };

    /// Calls `use` with the expected photoelectrons at each photosite of rows [begin, end).
    template <typename Photosite>
    void each(int begin, int end, const Photosite& use) {
        const bool mixed = shot_.crosstalk > 0;
        const int margin = mixed ? 1 : 0, width = light_.width;
        std::vector<float> expected(std::size_t(end - begin + 2 * margin) * width);
        for (int y = begin - margin; y < end + margin; ++y)
            expect(y, y >= begin && y < end, expected.data() + std::size_t(y - begin + margin) * width);
        for (int y = begin; y < end; ++y) {
            const float* const row = expected.data() + std::size_t(y - begin + margin) * width;
            const Keys keys{PixelRandom::row_key(shot_.seed, kShot, y),
                            PixelRandom::row_key(shot_.serial, kPattern, y)};
            for (int x = 0; x < width; ++x) use(x, y, mixed ? mix(row, x) : row[x], keys);
        }
    }

    int channel(int x, int y) const {
        return shot_.cells[std::size_t(y % shot_.cell_height) * shot_.cell_width + x % shot_.cell_width];
    }

    /// Tap on its row of the image.
    struct RowTap {
        const float* row;
        int dx;
        float weight;
    };

    std::vector<RowTap> taps_of_row(int y) const {
        std::vector<RowTap> out;
        for (const Tap& tap : taps_) {
            const std::size_t row = mirrored(y + tap.dy, light_.height);
            out.push_back({light_.data + row * light_.width * light_.count, tap.dx, tap.weight});
        }
        return out;
    }

    /// Photoelectrons behind a photosite's filter, summed over the taps of the low-pass filter.
    float light_at(int x, const std::vector<RowTap>& taps, const float* weights) const {
        float sum = 0;
        for (const RowTap& tap : taps) {
            int at = x + tap.dx;
            if (unsigned(at) >= unsigned(light_.width)) at = mirrored(at, light_.width);
            const float* const pixel = tap.row + std::size_t(at) * light_.count;
            sum += tap.weight * dot(weights, pixel, light_.count);
        }
        return sum;
    }

    /// Expected electrons of a row before crosstalk; y may be one row outside the image.
    void expect(int y, bool counted, float* row) {
        const int from = mirrored(y, light_.height);
        const std::vector<RowTap> taps = taps_of_row(from);
        std::int64_t negative = 0, bad = 0, first = std::numeric_limits<std::int64_t>::max();
        for (int x = 0; x < light_.width; ++x) {
            const float* const weights =
                shot_.electrons.data() + std::size_t(channel(x, from)) * light_.count;
            float value = light_at(x, taps, weights);
            if (!std::isfinite(value)) {
                first = std::min(first, std::int64_t(from) * light_.width + x);
                ++bad;
                value = 0;
            }
            negative += value < 0;
            row[x] = std::max(0.f, value);
        }
        if (counted) counts.add(negative, bad, first);
    }

    float mix(const float* row, int x) const {
        const int width = light_.width;
        const float sides = row[mirrored(x - 1, width)] + row[mirrored(x + 1, width)] + row[x - width] +
                            row[x + width];
        return float(1 - shot_.crosstalk) * row[x] + float(shot_.crosstalk / 4) * sides;
    }

    /// Fixed pattern of a sensor copy.
    struct Pattern {
        double response = 1, offset = 0, dark;
    };

    Pattern pattern(int x, std::uint64_t key) const {
        Pattern p{.dark = shot_.dark};
        if (shot_.prnu == 0 && shot_.dsnu == 0 && shot_.hot_share == 0) return p;
        PixelRandom random(key, x);
        const auto [a, b] = random.normal_pair();
        p.response = std::max(0., 1 + shot_.prnu * a);
        p.offset = shot_.dsnu * b;
        if (random.uniform() < shot_.hot_share) p.dark -= shot_.hot_dark * std::log(random.uniform());
        return p;
    }

    /// Draws the electrons from light and dark current, and converts them to a DN.
    void read(int x, int y, float expected, const Keys& keys) {
        const Pattern fixed = pattern(x, keys.pattern);
        PixelRandom random(keys.shot, x);
        const double mean = expected * fixed.response + fixed.dark;
        // The mean exceeds the full well by so much that no draw can be below it.
        const bool flooded = mean > 2 * shot_.full_well + 1000;
        const double well = std::floor(shot_.full_well);
        const double electrons = flooded ? well : std::min(well, poisson(mean, random));
        double noise = fixed.offset;
        if (shot_.read_noise > 0) noise += shot_.read_noise * random.normal_pair().a;
        const double number = std::floor(shot_.black_dn + shot_.gain * (electrons + noise) + 0.5);
        const int dn = int(std::clamp(number, 0., double(shot_.highest_dn)));
        const std::size_t at = std::size_t(y) * light_.width + x;
        out_.mosaic[at] = std::uint16_t(dn);
        out_.saturated[at] = electrons >= well || dn >= shot_.highest_dn;
    }

    const Planes& light_;
    const Shot& shot_;
    Exposed& out_;
    const std::vector<Tap> taps_;
};

/// Checks that cells refer to existing channels, and channels to existing planes.
void check(const Planes& light, const Shot& shot) {
    const auto want = [](bool good, const char* what, const char* wanted, double got) {
        if (!good) throw input_error("exposure", what, wanted, std::to_string(got));
    };
    want(light.width >= 1 && light.height >= 1, "light", "at least one pixel", 0);
    want(shot.electrons.size() == std::size_t(shot.channels) * light.count, "electrons",
         "a number for each channel and plane", double(shot.electrons.size()));
    want(shot.cell_width >= 1 && shot.cell_height >= 1, "cells", "at least one", 0);
    for (const std::uint8_t cell : shot.cells) want(cell < shot.channels, "cells", "channels", cell);
    want(shot.low_pass_px >= 0 && shot.low_pass_px <= kMostLowPass, "low-pass filter", "0 to 1000 px",
         shot.low_pass_px);
    want(shot.crosstalk >= 0 && shot.crosstalk <= 1, "crosstalk", "a share of 0 to 1", shot.crosstalk);
    for (const double value : {shot.prnu, shot.dsnu, shot.dark, shot.hot_share, shot.hot_dark, shot.read_noise, shot.gain})
        want(value >= 0 && std::isfinite(value), "noise and gain", "finite numbers of at least 0", value);
    want(shot.full_well >= 0, "full well", "electrons", shot.full_well);
}

template <typename Rows>
void in_blocks(int height, const Rows& rows) {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<int>(0, height, kBlock),
                              [&](const auto& r) { rows(r.begin(), r.end()); },
                              oneapi::tbb::simple_partitioner{});
}

}  // namespace

std::vector<float> expected_electrons(const Planes& light, const Shot& shot) {
    check(light, shot);
    std::vector<float> out(std::size_t(light.width) * light.height);
    Exposed unread;
    Exposing exposing(light, shot, unread);
    in_blocks(light.height, [&](int begin, int end) { exposing.expected_rows(begin, end, out); });
    return out;
}

Exposed expose(const Planes& light, const Shot& shot) {
    check(light, shot);
    Exposed out;
    const std::size_t count = std::size_t(light.width) * light.height;
    out.mosaic.resize(count);
    out.saturated.resize(count);
    Exposing exposing(light, shot, out);
    in_blocks(light.height, [&](int begin, int end) { exposing.rows(begin, end); });
    out.negative = exposing.counts.negative;
    out.bad = exposing.counts.bad;
    if (out.bad > 0) {
        const std::int64_t first = exposing.counts.first_bad;
        out.bad_x = int(first % light.width);
        out.bad_y = int(first / light.width);
    }
    return out;
}

}  // namespace dg
