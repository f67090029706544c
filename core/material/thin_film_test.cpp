// thin_film_test.cpp -- the closed form against the sum over bounces, against the formula of KHR_materials_iridescence,
// and in its limits.
#include "material/thin_film.h"

#include <doctest/doctest.h>

#include <complex>

#include "material/fresnel.h"
#include "math/vec.h"

namespace dg {
namespace {

const Spectrum kNm{430, 510, 590, 670};

using Amplitude = std::complex<double>;

/// Reflected light as the sum of waves after 0, 1, 2 ... round trips.
double by_bounces(bool p, double cos_o, double film, double base, double nm, double thick) {
    const auto cosine = [&](double n) {
        return std::sqrt(1 - (1 - cos_o * cos_o) / (n * n));
    };
    const double c1 = cos_o, c2 = cosine(film), c3 = cosine(base);
    const auto r = [&](double na, double ca, double nb, double cb) {
        return p ? (nb * ca - na * cb) / (nb * ca + na * cb)
                 : (na * ca - nb * cb) / (na * ca + nb * cb);
    };
    const auto t = [&](double na, double ca, double nb, double cb) {
        return 2 * na * ca / (p ? nb * ca + na * cb : na * ca + nb * cb);
    };
    const Amplitude turn = std::polar(1.0, 4 * kPiD * film * thick * c2 / nm);
    Amplitude sum = r(1, c1, film, c2);
    Amplitude wave = t(1, c1, film, c2) * t(film, c2, 1, c1) * r(film, c2, base, c3) * turn;
    for (int i = 0; i < 4000; ++i) {
        sum += wave;
        wave *= r(film, c2, 1, c1) * r(film, c2, base, c3) * turn;
    }
    return std::norm(sum);
}

/// I of the extension at normal incidence, where its Schlick terms are exact, for a single wavelength instead of the
/// eye's sensitivities, with all orders m.
double by_khronos(double film, double base_f0, double nm, double thickness) {
    const double root = std::sqrt(base_f0), base = (1 + root) / (1 - root);
    const auto f0 = [](double t, double i) { return std::pow((t - i) / (t + i), 2); };
    const double r12 = f0(film, 1), t121 = 1 - r12, r23 = f0(base, film);
    const double phi = kPiD + (base < film ? kPiD : 0);
    const double r123 = r12 * r23, rs = t121 * t121 * r23 / (1 - r123);
    double sum = r12 + rs, cm = rs - t121;
    for (int m = 1; m < 4000; ++m) {
        cm *= std::sqrt(r123);
        sum += cm * 2 * std::cos(m * (2 * kPiD * 2 * film * thickness / nm + phi));
    }
    return sum;
}

}  // namespace

TEST_CASE("a film reflects the sum of all its bounces") {
    for (float ior : {1.f, 1.33f, 2.2f}) {
        for (float thickness : {0.f, 120.f, 900.f}) {
            const ThinFilm film{ior, thickness, 1, kNm};
            const Spectrum base{1.1f, 1.5f, 2.f, 40.f};
            for (float cos_o : {1.f, 0.6f, 0.1f}) {
                const Spectrum r = film.reflectance(cos_o, base);
                for (int k = 0; k < kWavelengths; ++k) {
                    CAPTURE(k);
                    const double wanted =
                        0.5 * (by_bounces(false, cos_o, ior, base[k], kNm[k], thickness) +
                               by_bounces(true, cos_o, ior, base[k], kNm[k], thickness));
                    CHECK(r[k] == doctest::Approx(wanted).epsilon(2e-3));
                }
            }
        }
    }
}

TEST_CASE("at normal incidence it is the extension's formula at one wavelength") {
    for (float ior : {1.3f, 1.8f}) {
        for (float thickness : {100.f, 400.f, 1000.f}) {
            const ThinFilm film{ior, thickness, 1, kNm};
            const Spectrum f0{0.02f, 0.04f, 0.5f, 0.95f};
            const Spectrum r = film.reflectance(1, index_of_f0(f0));
            for (int k = 0; k < kWavelengths; ++k)
                CHECK(r[k] == doctest::Approx(by_khronos(ior, f0[k], kNm[k], thickness))
                                  .epsilon(1e-3));
        }
    }
}

TEST_CASE("without a film: Fresnel's law of the base") {
    for (const ThinFilm& film :
         {ThinFilm{1.7f, 0, 1, kNm}, ThinFilm{1, 500, 1, kNm}}) {
        for (float cos_o : {1.f, 0.7f, 0.2f, 0.02f}) {
            const Spectrum r = film.reflectance(cos_o, {1.2f, 1.5f, 1.5f, 3});
            CHECK(r[0] == doctest::Approx(fresnel_dielectric(cos_o, 1.2f)).epsilon(1e-4));
            CHECK(r[1] == doctest::Approx(fresnel_dielectric(cos_o, 1.5f)).epsilon(1e-4));
            CHECK(r[3] == doctest::Approx(fresnel_dielectric(cos_o, 3)).epsilon(1e-4));
        }
    }
    CHECK(index_of_f0(0.04f)[0] == doctest::Approx(1.5));
}

TEST_CASE("under a coat of the film's own index, the film cannot be seen") {
    const ThinFilm bare{1.5f, 0, 1.5f, kNm}, film{1.5f, 700, 1.5f, kNm};
    for (float cos_o : {1.f, 0.3f})
        CHECK(film.reflectance(cos_o, 2.f)[2] ==
              doctest::Approx(bare.reflectance(cos_o, 2.f)[2]));
    CHECK(film.reflectance(1, 2.f)[0] == doctest::Approx(std::pow(0.5 / 3.5, 2)));
}

TEST_CASE("envelope and Schlick bound lie above every film") {
    for (float ior : {1.2f, 1.6f, 2.5f}) {
        for (float base : {1.1f, 1.5f, 2.5f}) {
            const float f0 = schlick_bound({ior, 0, 1, kNm}, base);
            for (float c = 0.05f; c <= 1; c += 0.05f) {
                for (float thickness = 0; thickness < 800; thickness += 40) {
                    const ThinFilm film{ior, thickness, 1, kNm};
                    const float r = film.reflectance(c, base).max();
                    CHECK(r <= film.envelope(c, base)[0] + 1e-5f);
                    CHECK(r <= f0 + (1 - f0) * schlick(c) + 0.012f);
                }
            }
        }
    }
}

}  // namespace dg
