// records.h -- records that the layers of a film store for each pixel.
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>

#include "film/aov.h"
#include "film/fixed_sum.h"
#include "math/vec.h"

namespace dg {

/// A record consists of words without padding, which files store as they are. A default record has no samples. add()
/// merges the record of another film; the order of merging changes no bit.
template <class R>
concept LayerRecord = std::is_trivially_copyable_v<R> && std::has_unique_object_representations_v<R> &&
                      std::default_initializable<R> && sizeof(R) % sizeof(std::uint32_t) == 0 &&
                      requires(R sums, const R& more) { sums.add(more); };

/// A record with values(): Film::means divides these sums by the count of samples.
template <class R>
concept HasMeans = LayerRecord<R> && requires(const R& sums) {
    { sums.values() } -> std::convertible_to<std::span<const ValueSum>>;
};

/// A record with settle(), which repairs words read from a file.
template <class R>
concept Settles = LayerRecord<R> && requires(R& sums) { sums.settle(); };

/// Matrix from XYZ to linear Rec.709, rows.
using RgbRows = std::array<Vec3f, 3>;

inline constexpr std::uint32_t kNoSample = 0xffffffffu;

struct XyzSums {
    ValueSum xyz[3];
    std::span<const ValueSum> values() const { return xyz; }
    void add(const XyzSums& more) {
        for (int k = 0; k < 3; ++k) xyz[k].add(more.xyz[k]);
    }
};

/// Sums of X, Y, Z, and of the squares of linear Rec.709 R, G, B.
struct ColorSums {
    ValueSum xyz[3];
    SquareSum rgb_squares[3];
    std::span<const ValueSum> values() const { return xyz; }
    void add_squares(const RgbRows& rows, Vec3f color) {
        const Vec3d rgb = to_double(Vec3f{dot(rows[0], color), dot(rows[1], color), dot(rows[2], color)});
        rgb_squares[0].add(std::min(rgb.x * rgb.x, kMaxFilmSquare));
        rgb_squares[1].add(std::min(rgb.y * rgb.y, kMaxFilmSquare));
        rgb_squares[2].add(std::min(rgb.z * rgb.z, kMaxFilmSquare));
    }
    void add(const ColorSums& more) {
        for (int k = 0; k < 3; ++k) xyz[k].add(more.xyz[k]);
        for (int k = 0; k < 3; ++k) rgb_squares[k].add(more.rgb_squares[k]);
    }
};

/// Camera samples of a pixel.
struct CameraSums : ColorSums {
    std::uint32_t count = 0, bad = 0, first_bad = kNoSample;
    std::uint32_t lock = 0;   // spin lock of add_locked(); 0: open
    void mark_bad(std::uint32_t sample) {
        ++bad;
        first_bad = std::min(first_bad, sample);
    }
    void add(const CameraSums& more) {
        ColorSums::add(more);
        count += more.count;
        bad += more.bad;
        first_bad = std::min(first_bad, more.first_bad);
    }
    /// Opens the lock: a closed lock from a damaged file would block forever.
    void settle() { lock = 0; }
};

/// XYZ of samples with even indices: of camera paths and of light paths.
struct HalfSums {
    ValueSum own[3], splats[3];
    std::uint32_t count = 0, unused[3] = {};
    void add(const HalfSums& more) {
        for (int k = 0; k < 3; ++k) own[k].add(more.own[k]), splats[k].add(more.splats[k]);
        count += more.count;
    }
};

/// Weight of all samples, and the part that objects cover, in whole steps of 2^-30: 2^33 samples of weight 1 fit.
struct CoverageSums {
    std::int64_t white = 0, covered = 0;
    void add(const CoverageSums& more) {
        white += more.white;
        covered += more.covered;
    }
};

struct AovSums {
    std::array<ValueSum, kAovChannels.size()> sums;   // in the order of kAovChannels
    std::uint32_t passed = 0, hits = 0, object_sample = kNoSample, object_id = 0;
    void add(const AovSums& more) {
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(more.sums[k]);
        passed += more.passed;
        hits += more.hits;
        take_object(more.object_sample, more.object_id);
    }
    /// Keeps the object of the sample with the lowest index.
    void take_object(std::uint32_t sample, std::uint32_t id) {
        if (sample < object_sample) object_sample = sample, object_id = id;
    }
};

}  // namespace dg
