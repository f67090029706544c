// environment.cpp -- light from infinity.
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

}  // namespace

Rgb Environment::Picture::at(SkyTexels texels) const {
    const float column = std::floor(texels.column - 0.5f), x = texels.column - 0.5f - column;
    const float row = std::floor(texels.row - 0.5f), y = texels.row - 0.5f - row;
    const int c = grid.wrap(int(column)), next = grid.wrap(c + 1), r = int(row);
    const Rgb* top = pixels->data() + std::size_t(grid.clamp_row(r)) * grid.width;
    const Rgb* low = pixels->data() + std::size_t(grid.clamp_row(r + 1)) * grid.width;
    const Rgb a = top[c] * (1 - x) + top[next] * x, b = low[c] * (1 - x) + low[next] * x;
    return a * (1 - y) + b * y;
}

float Environment::Picture::pdf(SkyTexels at, Vec3f direction) const {
    if (!(blocks.total() > 0)) return 0;
    return blocks.weight(grid, grid.place(at), direction) / float(blocks.total());
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
    std::vector<float> luminance;
    luminance.reserve(image.pixels.size());
    for (Rgb& p : image.pixels) p = p * scale, luminance.push_back(dg::luminance(p));
    picture->pixels = std::make_shared<const std::vector<Rgb>>(std::move(image.pixels));
    picture->grid = SkyGrid(image.width, image.height, std::move(luminance));
    picture->blocks = SkyBlocks(picture->grid);
    picture->world_from_environment = world_from_environment;
    picture->environment_from_world = inverse(world_from_environment);

    Environment e;
    e.mean_luminance_ = static_cast<float>(picture->blocks.total() / (4 * kPiD));
    e.picture_ = std::move(picture);
    return e;
}

Environment Environment::compensated() const {
    if (!picture_) return *this;
    auto picture = std::make_shared<Picture>(*picture_);
    picture->grid = picture_->grid.compensated(float(picture_->blocks.total() / (4 * kPiD)));
    picture->blocks = SkyBlocks(picture->grid);
    Environment e = *this;
    e.picture_ = std::move(picture);
    return e;
}

Rgb Environment::luminance_within(Vec3f direction) const {
    if (!picture_) return constant_;
    const Picture& p = *picture_;
    return p.at(p.grid.texels(p.environment_from_world.vector(direction)));
}

Environment::Lookup Environment::lookup_within(Vec3f direction) const {
    if (!picture_) return {constant_, warp_sphere_pdf()};
    const Picture& p = *picture_;
    const Vec3f d = p.environment_from_world.vector(direction);
    const SkyTexels at = p.grid.texels(d);
    return {p.at(at), p.pdf(at, d)};
}

Environment::Sample Environment::sample_within(Vec2f u) const {
    if (!picture_) return {warp_sphere(u), warp_sphere_pdf(), mean_luminance_};
    const Picture& p = *picture_;
    if (!(p.blocks.total() > 0)) return {warp_sphere(u), 0, 0};  // a black picture
    const SkyDraw draw = p.blocks.sample(p.grid, u);
    return {normalize(p.world_from_environment.vector(draw.direction)), draw.weight / float(p.blocks.total()),
            p.grid.luminance_of(draw.weight)};
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
    const Vec3f d = p.environment_from_world.vector(direction);
    return p.pdf(p.grid.texels(d), d);
}

}  // namespace dg
