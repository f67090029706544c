// environment.cpp -- light from infinity.
//
// The picture is divided into cells between its texel centers, w columns by h + 1 rows (the first and last row have
// half the height and touch the poles). In a cell, with x in [0,1] along azimuth and s in [0,1] linear in cos theta (so
// that equal areas of (x, s) are equal solid angles), the density interpolates the four texel luminances bilinearly.
// Its integral over a cell is mean * solid angle, hence
//   pdf(direction) = bilinear luminance / sum over cells(mean * solid angle),
// which is continuous. The small difference between s and the picture's v causes little noise.
#include "light/environment.h"

#include "light/environment_picture.h"
#include "math/error.h"
#include "math/warp.h"

namespace dg {

namespace {

void check_image(const EnvironmentImage& image) {
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() != std::size_t(image.width) * image.height) {
        throw input_error(
            "environment", "size of the picture", "width * height pixels, at least one",
            std::to_string(image.width) + " x " + std::to_string(image.height) +
                " with " + std::to_string(image.pixels.size()) + " pixels");
    }
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb p = image.pixels[i];
        const bool good =
            p.x >= 0 && p.y >= 0 && p.z >= 0 && std::isfinite(p.x + p.y + p.z);
        if (good) continue;
        throw input_error("environment",
                          "pixel at row " + std::to_string(i / image.width) +
                              ", column " + std::to_string(i % image.width),
                          "finite values >= 0",
                          "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                              std::to_string(p.z) + ")");
    }
}

void check_rotation(const Affine3f& m) {
    const bool good =
        std::abs(length(m.x) - 1) < 1e-3f && std::abs(length(m.y) - 1) < 1e-3f &&
        std::abs(length(m.z) - 1) < 1e-3f && std::abs(dot(m.x, m.y)) < 1e-3f &&
        std::abs(dot(m.y, m.z)) < 1e-3f && std::abs(dot(m.z, m.x)) < 1e-3f;
    if (!good) {
        throw input_error("environment", "transform", "a rotation",
                          "axes of length " + std::to_string(length(m.x)) + ", " +
                              std::to_string(length(m.y)) + ", " +
                              std::to_string(length(m.z)) + " or not orthogonal");
    }
}

float bilinear(const std::array<float, 4>& c, float x, float y) {
    const float top = c[0] + (c[1] - c[0]) * x, low = c[2] + (c[3] - c[2]) * x;
    return top + (low - top) * y;
}

/// Samples x in [0,1] with a density proportional to a + (b - a) x, by the inverse of its quadratic CDF in a form
/// without cancellation.
float sample_linear(float u, float a, float b) {
    if (a + b <= 0) return u;
    const float x =
        u * (a + b) / (a + std::sqrt(std::max(0.f, a * a + u * (b * b - a * a))));
    return std::isfinite(x) ? std::min(x, 1.f) : u;
}

float fraction(float cells) {
    return std::clamp(cells - std::floor(cells), 0.f, 1.f);
}

/// Column coordinate in texels, [0, w), with 0 at the left edge of the picture.
float column_of(Vec3f d, int width) {
    const float u = 0.5f + atan2(d.x, -d.z) / (2 * kPi);
    return std::clamp(u, 0.f, 1.f) * width;
}
float theta_of(Vec3f d) {
    return atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y);
}

/// Column of cells; cells start half a texel to the right of the picture's edge.
struct CellColumn {
    int c;
    float x;
};
CellColumn cell_column(float texels, int width) {
    const float shifted = texels - 0.5f;
    const float floor = std::floor(shifted);
    int c = static_cast<int>(floor);
    if (c < 0) c += width;
    if (c >= width) c -= width;
    return {c, shifted - floor};
}

}  // namespace

void Environment::Picture::build_cells() {
    lum.resize(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) lum[i] = dg::luminance(pixels[i]);
    cos_edge.resize(height + 2);
    cos_edge.front() = 1;
    cos_edge.back() = -1;
    for (int r = 1; r <= height; ++r) {
        cos_edge[r] = static_cast<float>(std::cos(kPiD * (r - 0.5) / height));
    }
    std::vector<float> weights(std::size_t(width) * (height + 1));
    for (int r = 0; r <= height; ++r) {
        for (int c = 0; c < width; ++c) {
            const double w = weight(c, r);
            weights[std::size_t(r) * width + c] = static_cast<float>(w);
            total += w;
        }
    }
    if (total > 0) cells = Distribution2D(width, height + 1, weights);
}

Vec3f Environment::Picture::direction(int c, int r, float x, float s) const {
    const float cos_theta = cos_edge[r] + (cos_edge[r + 1] - cos_edge[r]) * s;
    const float sin_theta = std::sqrt(std::max(0.f, 1 - cos_theta * cos_theta));
    const float phi = 2 * kPi * ((c + 0.5f + x) / width - 0.5f);  // 0 along -z
    return {sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)};
}

Vec3f Environment::Picture::sample_in(int c, int r, Vec2f u) const {
    const auto k = corners(c, r);
    const float s = sample_linear(u.y, k[0] + k[1], k[2] + k[3]);
    const float x = sample_linear(u.x, k[0] + (k[2] - k[0]) * s, k[1] + (k[3] - k[1]) * s);
    return direction(c, r, x, s);
}

Environment::Picture::Place Environment::Picture::place(Vec3f d) const {
    const auto [c, x] = cell_column(column_of(d, width), width);
    const int r =
        std::clamp(static_cast<int>(std::floor(theta_of(d) / kPi * height + 0.5f)), 0, height);
    const float s = (cos_edge[r] - d.y) / (cos_edge[r] - cos_edge[r + 1]);
    return {c, r, bilinear(corners(c, r), x, std::clamp(s, 0.f, 1.f))};
}

Environment Environment::constant(Rgb luminance) {
    const bool good = luminance.x >= 0 && luminance.y >= 0 && luminance.z >= 0 &&
                      std::isfinite(luminance.x + luminance.y + luminance.z);
    if (!good) {
        throw input_error("environment", "luminance", "finite values >= 0",
                          "(" + std::to_string(luminance.x) + ", " +
                              std::to_string(luminance.y) + ", " +
                              std::to_string(luminance.z) + ")");
    }
    Environment e;
    e.constant_ = luminance;
    e.mean_luminance_ = dg::luminance(luminance);
    return e;
}

Environment Environment::image(EnvironmentImage image, float scale,
                               const Affine3f& world_from_environment) {
    check_image(image);
    check_rotation(world_from_environment);
    if (!(scale >= 0) || !std::isfinite(scale)) {
        throw input_error("environment", "scale", "a finite number >= 0",
                          std::to_string(scale));
    }
    auto picture = std::make_shared<Picture>();
    picture->width = image.width;
    picture->height = image.height;
    picture->pixels = std::move(image.pixels);
    for (Rgb& p : picture->pixels) p = p * scale;
    picture->world_from_environment = world_from_environment;
    picture->environment_from_world = inverse(world_from_environment);
    picture->build_cells();

    Environment e;
    e.mean_luminance_ = static_cast<float>(picture->total / (4 * kPiD));
    e.picture_ = std::move(picture);
    return e;
}

Rgb Environment::luminance_within(Vec3f direction) const {
    if (!picture_) return constant_;
    const Picture& p = *picture_;
    const Vec3f d = p.environment_from_world.vector(direction);
    const auto [c, x] = cell_column(column_of(d, p.width), p.width);
    const float v = theta_of(d) / kPi * p.height - 0.5f;
    const float floor = std::floor(v), y = v - floor;
    const int r = static_cast<int>(floor);
    const Rgb* top = &p.pixels[std::size_t(p.clamp_row(r)) * p.width];
    const Rgb* low = &p.pixels[std::size_t(p.clamp_row(r + 1)) * p.width];
    const int next = p.wrap(c + 1);
    const Rgb a = top[c] * (1 - x) + top[next] * x, b = low[c] * (1 - x) + low[next] * x;
    return a * (1 - y) + b * y;
}

Environment::Sample Environment::sample_within(Vec2f u) const {
    if (!picture_) return {warp_sphere(u), warp_sphere_pdf()};
    const Picture& p = *picture_;
    if (p.cells.empty()) return {warp_sphere(u), 0};  // a black picture
    const Sample2D cell = p.cells.sample(u);
    const int c = std::min(static_cast<int>(cell.x * p.width), p.width - 1);
    const int r = std::min(static_cast<int>(cell.y * (p.height + 1)), p.height);
    const Vec3f d = p.sample_in(c, r, {fraction(cell.x * p.width), fraction(cell.y * (p.height + 1))});
    const Vec3f world = normalize(p.world_from_environment.vector(d));
    // Evaluated for the rounded direction, so that sample and pdf agree in steep cells, too.
    return {world, pdf_within(world)};
}

Vec3f Environment::to_picture(Vec3f direction, float time) const {
    if (!picture_) return direction;
    return picture_->environment_from_world.vector(turned(direction, time, -1));
}

Vec3f Environment::to_world(Vec3f direction, float time) const {
    if (!picture_) return direction;
    return turned(picture_->world_from_environment.vector(direction), time, 1);
}

float Environment::pdf_within(Vec3f direction) const {
    if (!picture_) return warp_sphere_pdf();
    const Picture& p = *picture_;
    if (p.cells.empty()) return 0;
    const Vec3f d = p.environment_from_world.vector(direction);
    return p.place(d).luminance / static_cast<float>(p.total);
}

}  // namespace dg
