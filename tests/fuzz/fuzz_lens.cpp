// fuzz_lens.cpp -- any prescription: an Error, or a lens through which rays can be drawn.
#include <cmath>

#include "camera/exact.h"
#include "math/error.h"
#include "input.h"

namespace dg {
namespace {

double length(FuzzInput& in) {
    return 10 * double(in.number());
}

Glass any_glass(FuzzInput& in) {
    Glass glass;
    switch (in.below(5)) {
        case 0: break;
        case 1: glass.formula = ConstantIndex{1 + double(in.factor())}; break;
        case 2: glass.formula = AbbeGlass{1.3 + in.factor(), 10 + 60 * double(in.factor())}; break;
        case 3: {
            TableGlass table;
            double nm = 300;
            for (int n = in.below(5); n > 0; --n) {
                table.nm.push_back(nm += 100 * in.number());
                table.n.push_back(1 + double(in.factor()));
            }
            glass.formula = table;
            break;
        }
        default: {
            SellmeierGlass s;
            for (int i = in.below(5); i > 0; --i) {
                s.b.push_back(in.factor());
                if (in.below(16)) s.c.push_back(in.factor());
            }
            glass.formula = s;
        }
    }
    return glass;
}

void any_form(FuzzInput& in, Surface& s) {
    s.shape = Shape(in.below(3));
    s.conic = length(in);
    if (in.flag()) s.curvature_x = 1 / length(in), s.conic_x = length(in);
    for (int i = in.below(4); i > 0; --i)
        s.asphere.push_back({in.below(24), in.number() * std::pow(0.1, in.below(12))});
    if (in.flag()) s.decenter = {length(in), length(in), length(in)};
    if (in.flag()) s.tilt = {length(in), length(in), length(in)};
    s.inner_semi_diameter = in.flag() ? length(in) : 0;
    s.semi_diameter_after = in.flag() ? length(in) : 0;
}

Prescription any_lens(FuzzInput& in) {
    Prescription lens;
    lens.name = "lens";
    const int count = in.below(9);
    const int stop = in.below(count + 1);
    for (int i = 0; i < count; ++i) {
        Surface s;
        const double radius = length(in);
        s.curvature = in.below(4) == 0 || i == stop ? 0 : 1 / radius;
        s.thickness = length(in);
        if (in.below(4) != 0) s.semi_diameter = length(in);
        s.glass = any_glass(in);
        s.stop = i == stop;
        if (in.flag()) any_form(in, s);
        lens.surfaces.push_back(s);
    }
    lens.nominal_f_number = in.number();
    return lens;
}

void draw(const ExactLens& lens, FuzzInput& in) {
    std::vector<CameraSample> samples(4);
    std::vector<CameraRay> rays(4);
    for (CameraSample& s : samples) {
        s.film_mm = {10 * in.number(), 10 * in.number()};
        s.u_lens = {in.factor() * 0.99f, 0.5f};
        s.time = 0;
        s.wavelength_nm = 550;
    }
    lens.generate(samples, rays);
    std::vector<float> nm(4, 450.f);
    std::vector<Reprojection> back(4);
    lens.reproject(rays, nm, back);
    lens.chief_direction({5, 5});
}

}  // namespace
}  // namespace dg

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    dg::FuzzInput in(data, size);
    try {
        dg::ExactLensSettings settings;
        settings.f_stop = in.flag() ? in.number() : 0;
        if (in.flag()) settings.focus_distance_m = in.number();
        // The fit takes seconds here.
        settings.draw = in.below(16) ? dg::PupilDraw::slope_boxes : dg::PupilDraw::aimed;
        const dg::Prescription lens = dg::any_lens(in);
        dg::draw(dg::ExactLens(lens, settings), in);
    } catch (const dg::Error&) {
    }
    return 0;
}
