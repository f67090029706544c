// film.h -- linear sums per pixel. Every sum is exact (fixed point, 128 bits), so that neither the order
// of samples, nor the number of threads, nor the way a frame was split and merged changes a bit.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "film/fixed_sum.h"
#include "math/vec.h"

namespace dg {

/// A sample that had to be dropped, with the place to look for it.
struct BadSample {
    int x, y;
    std::uint32_t sample;
};

/// Auxiliary values of one camera sample's first hit; only samples that passed the lens bring them.
struct AovSample {
    bool hit = false;
    float depth = 0;             // m, along the camera's -z
    Vec3f position, normal, albedo;
    std::uint32_t object_id = 0; // instance index + 1; 0 is nothing
    float alpha = 1;             // 1 where something was hit
};

struct FilmLayout {
    int width = 0, height = 0;                  // of the region that is stored
    int offset_x = 0, offset_y = 0;             // of that region in the full frame
    bool aovs = false;
};

class Film {
  public:
    explicit Film(FilmLayout layout);
    const FilmLayout& layout() const;

    /// Adds one sample to a pixel (full-frame coordinates; outside the region: ignored). Each value of
    /// xyz is a float; NaN, Inf or beyond the accumulator: the sample is counted as bad, and 0 is added.
    /// Not thread safe for the same pixel: tiles own their pixels, or use FilmTile.
    void add(int x, int y, std::uint32_t sample, Vec3f xyz);
    void add_aov(int x, int y, std::uint32_t sample, const AovSample& aov);
    /// To be called once per camera sample and pixel: the divisor of the mean.
    void count(int x, int y);

    /// Exact: a.merge(b) equals having drawn all samples into one film. Throws Error if layouts differ.
    void merge(const Film& other);

    /// Mean CIE XYZ per pixel, float32 rows from the top, size 3*width*height.
    std::vector<float> mean_xyz() const;
    /// Variance of the mean of linear Rec.709 R, G, B (see film.cpp for the estimator).
    std::vector<float> variance_rgb() const;
    std::vector<std::uint32_t> sample_counts() const;
    std::vector<float> aov(const std::string& name) const;  // depth.Z, P.X ..., N.X ..., albedo.R ..., alpha
    std::vector<std::uint32_t> object_ids() const;

    const std::vector<BadSample>& bad_samples() const;  // the first 100
    std::uint64_t bad_sample_count() const;

    /// The whole state as plain 32-bit words (little endian by value): one vector per named channel,
    /// each width*height words. What pass files store and read back.
    std::vector<std::string> state_channels() const;
    std::vector<std::uint32_t> state(const std::string& channel) const;
    void set_state(const std::string& channel, const std::vector<std::uint32_t>& words);
};

}  // namespace dg
