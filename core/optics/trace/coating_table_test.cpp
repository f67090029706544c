#include "optics/trace/coating_table.h"

#include <doctest/doctest.h>

#include <cmath>

#include "optics/lens/coating.h"
#include "optics/trace/lens_tables.h"

using namespace dg;

namespace {

/// The table's value, computed in the kernel's order of operations and in float.
float table_value(const CoatingTable& t, float cosine, float l) {
    const float x = 2 * cosine - 1, root = 1 + t.pole * cosine;
    float sum = 0;
    const float* c = t.coefficients.data();
    for (const int terms : t.terms) {
        float row = c[0];
        for (int m = 1; m < terms; ++m) row = row * l + c[m];
        sum = sum * x + row;
        c += terms;
    }
    return cosine * sum / (root * root);
}

/// Largest error of a table over a grid of cosines and wavelengths.
double worst_error(const CoatingTable& t, const SurfaceCoating& coating, const Glass& rarer,
                   const Glass& denser) {
    const WavelengthScale scale = WavelengthScale::visible();
    double worst = 0;
    for (double nm = 380; nm <= 780; nm += 4) {
        const double n1 = refractive_index(rarer, nm), n2 = refractive_index(denser, nm);
        for (double c = 0; c <= 1.0001; c += 0.01) {
            const double cos1 = std::min(c, 1.0), mu = n1 / n2;
            const double cos2 = std::sqrt(1 - mu * mu * (1 - cos1 * cos1));
            const double t0 = surface_transmittance(coating, n1, cos1, n2, cos2, nm);
            const double value = table_value(t, float(cos1), float(scale(nm)));
            worst = std::max(worst, std::abs(value - t0));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("tables of films stay within 1e-4 at all angles and wavelengths") {
    const Glass glasses[] = {{AbbeGlass{1.38, 90}, ""},  {AbbeGlass{1.4338, 95}, ""},
                             {AbbeGlass{1.5168, 64}, ""}, {AbbeGlass{1.62, 36}, ""},
                             {AbbeGlass{1.7, 30}, ""},   {AbbeGlass{1.7495, 35}, ""},
                             {AbbeGlass{1.7505, 35}, ""}, {AbbeGlass{1.8052, 25.4}, ""},
                             {AbbeGlass{1.9229, 20}, ""}, {AbbeGlass{2.05, 17}, ""},
                             {AbbeGlass{1.85, 80}, ""}};
    std::size_t most = 0;
    for (const Glass& air : {Glass{}, water(), vacuum()})
        for (const Coating preset :
             {Coating::mgf2, Coating::v_coat, Coating::broadband})
            for (const Glass& glass : glasses) {
                const double n = refractive_index(glass, 587.56);
                if (n < 1.43 && refractive_index(air, 587.56) > 1.3) continue;  // such a pair of media does not
                                                                                // occur in lenses
                const SurfaceCoating coating =
                    coat(preset, refractive_index(air, kFilmWavelength),
                         refractive_index(glass, kFilmWavelength));
                const CoatingTable t =
                    coating_table(coating, air, glass, WavelengthScale::visible());
                const CoatingTable back =
                    coating_table(coating, glass, air, WavelengthScale::visible());
                CHECK(t.coefficients == back.coefficients);
                INFO(int(preset) << " n " << n);
                CHECK(worst_error(t, coating, air, glass) < 1e-4);
                most = std::max(most, t.coefficients.size());
            }
    CHECK(most < 220);
}

TEST_CASE("surfaces without films have no table") {
    CHECK(coating_table({}, Glass{}, Glass{ConstantIndex{1.5}, ""}, WavelengthScale::visible())
              .terms.empty());
}
