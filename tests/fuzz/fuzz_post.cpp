// fuzz_post.cpp -- pictures, maps, depths and motions of any numbers through the effects that move light: an Error, or a
// picture of the stated size.
#include <cstdlib>

#include "input.h"
#include "math/error.h"
#include "post/defocus.h"
#include "post/motion_blur.h"
#include "post/remap.h"

namespace dg {
namespace {

constexpr int kCellPixels = SourceMap::kCell * SourceMap::kCell;

std::vector<float> numbers(FuzzInput& in, std::size_t count) {
    std::vector<float> made(count);
    const bool calm = in.flag();   // a few odd numbers among many that are alike
    for (float& v : made) v = calm && in.below(16) ? 0.5f : in.number();
    return made;
}

void remap_any(FuzzInput& in) {
    const int width = 1 + in.below(40), height = 1 + in.below(40), channels = 1 + in.below(3);
    const int columns = in.below(4), rows = in.below(4), cells = in.below(3);
    const std::vector<float> nodes = numbers(in, std::size_t(rows + 3) * (columns + 3) * 2 + (in.below(32) == 31));
    std::vector<std::int32_t> exact(std::size_t(rows) * columns, -1);
    for (std::int32_t& e : exact)
        if (in.flag()) e = in.below(4) - 1;
    const std::vector<float> exact_cells = numbers(in, std::size_t(cells) * kCellPixels * 2);
    const SourceMap map{columns, rows, 16 * (in.below(3) - 1), nodes, exact, exact_cells};
    map.check();
    const std::vector<float> values = numbers(in, std::size_t(width) * height * channels);
    const RemapSource source{values, width, height, channels, 0};
    const std::vector<int> map_of(channels, in.below(16) == 15);
    const int begin = in.below(height), end = begin + 1 + in.below(height - begin);
    const auto made = remap(source, std::span(&map, 1), map_of, begin, end, RemapFilter(in.below(2)), in.flag());
    if (made.size != std::size_t(width) * channels * (end - begin)) std::abort();
    const std::vector<std::uint32_t> words(std::size_t(width) * height, 7);
    remap_nearest(words, width, height, 0, map, begin, end);
}

IrisShape any_iris(FuzzInput& in) {
    if (in.flag()) return IrisShape::image(3, 2, numbers(in, 6));
    std::vector<Vec2d> corners(in.below(8));
    for (Vec2d& c : corners) c = {double(in.number()), double(in.number())};
    return IrisShape::outline(corners);
}

void spread_any(FuzzInput& in) {
    const int width = 1 + in.below(24), height = 1 + in.below(16);
    const std::size_t pixels = std::size_t(width) * height;
    const std::vector<float> values = numbers(in, 4 * pixels);
    const SpreadRows rows{0, height};
    if (in.flag()) {
        std::vector<float> radius = numbers(in, pixels);
        for (float& r : radius)
            if (std::abs(r) > 1e4f && std::isfinite(r)) r = 40;   // kernels of such a size take minutes
        defocus(width, values, radius, any_iris(in), rows);
        return;
    }
    std::vector<float> next = numbers(in, 2 * pixels), last = numbers(in, 2 * pixels);
    for (std::vector<float>* motion : {&next, &last})
        for (float& m : *motion)
            if (std::abs(m) > 1e3f && std::isfinite(m)) m = 30;
    motion_blur(width, values, {next, last}, numbers(in, pixels), in.factor(), ShutterTime{}, rows);
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    dg::FuzzInput in(data, size);
    try {
        in.flag() ? dg::remap_any(in) : dg::spread_any(in);
    } catch (const dg::Error&) {
    }
    return 0;
}
