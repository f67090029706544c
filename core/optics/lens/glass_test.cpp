#include "optics/lens/glass.h"

#include <doctest/doctest.h>

#include <cmath>

#include "math/error.h"

using namespace dg;

TEST_CASE("a glass of nd and Vd hits both and lies on the normal line") {
    const Glass g{AbbeGlass{1.5168, 64.17}, "N-BK7"};
    const double nd = refractive_index(g, 587.5618), nf = refractive_index(g, 486.1327);
    const double nc = refractive_index(g, 656.2725), ng = refractive_index(g, 435.8343);
    CHECK(nd == doctest::Approx(1.5168).epsilon(1e-14));
    CHECK((nd - 1) / (nf - nc) == doctest::Approx(64.17).epsilon(1e-10));
    CHECK((ng - nf) / (nf - nc) ==
          doctest::Approx(0.6438 - 0.001682 * 64.17).epsilon(1e-9));
}

TEST_CASE("a glass of nd, Vd and theta_gF hits all three; of the normal line's, the same as without") {
    const Glass g{PartialGlass{1.497, 81.54, 0.5375}, "S-FPL51"};
    const double nf = refractive_index(g, 486.1327), nc = refractive_index(g, 656.2725);
    CHECK(refractive_index(g, 587.5618) == doctest::Approx(1.497).epsilon(1e-14));
    CHECK(0.497 / (nf - nc) == doctest::Approx(81.54).epsilon(1e-10));
    CHECK((refractive_index(g, 435.8343) - nf) / (nf - nc) == doctest::Approx(0.5375).epsilon(1e-9));
    const Glass line{PartialGlass{1.6, 40, 0.6438 - 0.001682 * 40}, ""}, abbe{AbbeGlass{1.6, 40}, ""};
    for (double nm = 400; nm <= 700; nm += 10) CHECK(refractive_index(line, nm) == refractive_index(abbe, nm));
}

TEST_CASE("a matched glass has nd and Vd of the file and all ratios of dispersion of the catalogue") {
    const Glass bk7{SellmeierGlass{{1.03961212, 0.231792344, 1.01046945},
                                   {0.00600069867, 0.0200179144, 103.560653}},
                    "N-BK7"};
    for (const bool vacuum : {false, true}) {
        Glass like = bk7;
        like.against_vacuum = vacuum;
        const Glass g{matched(like, 1.5163, 64.1, "x"), ""};
        const auto n = [](const Glass& glass, double nm) { return refractive_index(glass, nm); };
        CHECK(n(g, 587.5618) == doctest::Approx(1.5163).epsilon(1e-15));
        CHECK(0.5163 / (n(g, 486.1327) - n(g, 656.2725)) == doctest::Approx(64.1).epsilon(1e-10));
        for (double nm = 400; nm <= 700; nm += 25)
            CHECK((n(g, nm) - n(g, 486.1327)) / (n(g, 486.1327) - n(g, 656.2725)) ==
                  doctest::Approx((n(like, nm) - n(like, 486.1327)) / (n(like, 486.1327) - n(like, 656.2725))).epsilon(1e-9));
    }
    CHECK_THROWS_AS(matched({ConstantIndex{1.5}, ""}, 1.5, 60, "x"), Error);
    CHECK_THROWS_AS(matched({AbbeGlass{1.5, 60}, ""}, 1.5, 60, "x"), Error);
    CHECK_THROWS_AS(matched(bk7, 1.5, 0, "x"), Error);
}

TEST_CASE("Sellmeier: N-BK7 of the Schott catalogue") {
    const Glass g{SellmeierGlass{{1.03961212, 0.231792344, 1.01046945},
                                 {0.00600069867, 0.0200179144, 103.560653}},
                  "N-BK7"};
    CHECK(refractive_index(g, 587.5618) == doctest::Approx(1.51680).epsilon(1e-6));
    CHECK(refractive_index(g, 435.8343) == doctest::Approx(1.52668).epsilon(3e-6));
    // The Cauchy formula from nd and Vd stays within the error quoted for the normal line.
    const Glass abbe{AbbeGlass{1.5168, 64.17}, ""};
    for (double nm = 400; nm <= 700; nm += 10)
        CHECK(std::abs(refractive_index(g, nm) - refractive_index(abbe, nm)) < 1e-3);
}

TEST_CASE("a table is exact at its nodes and smooth between them") {
    const Glass smooth{AbbeGlass{1.7, 40}, ""};
    TableGlass table;
    for (double nm = 380; nm <= 800; nm += 35)
        table.nm.push_back(nm), table.n.push_back(refractive_index(smooth, nm));
    const Glass g{table, ""};
    for (std::size_t i = 0; i < table.nm.size(); ++i)
        CHECK(refractive_index(g, table.nm[i]) == table.n[i]);
    for (double nm = 381; nm < 799; nm += 7)
        CHECK(refractive_index(g, nm) ==
              doctest::Approx(refractive_index(smooth, nm)).epsilon(1e-8));
}

TEST_CASE("absurd glasses are refused by place") {
    CHECK_THROWS_WITH_AS(check_glass({AbbeGlass{0.2, 50}, ""}, "lens: surface 3"),
                         doctest::Contains("lens: surface 3"), Error);
    CHECK_THROWS_AS(check_glass({AbbeGlass{1.5, 0}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({PartialGlass{1.5, 60, 0.9}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({PartialGlass{1.5, 60, std::nan("")}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({TableGlass{{500, 400}, {1.5, 1.5}}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({TableGlass{{}, {}}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({ConstantIndex{std::nan("")}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({SellmeierGlass{{1, 2}, {0.01}}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({PolynomialGlass{{}, {}}, ""}, "x"), Error);
    CHECK_THROWS_AS(check_glass({PolynomialGlass{{-1}, {0}}, ""}, "x"), Error);
}

TEST_CASE("Schott's polynomial, and Sellmeier's series of any length") {
    // J-BK7A of the Nikon (Hikari) catalogue of 2017: nd 1.516800, Vd 64.12995.
    const Glass bk7{PolynomialGlass{{2.27110883, -0.00938988354, -0.000100277081,
                                     0.0109572221, 0.000120210067, 3.31079774e-06,
                                     -1.48235581e-08},
                                    {0, 2, 4, -2, -4, -6, -8}},
                    "J-BK7A"};
    const double nd = refractive_index(bk7, 587.5618);
    CHECK(nd == doctest::Approx(1.5168).epsilon(1e-7));
    CHECK((nd - 1) / (refractive_index(bk7, 486.1327) - refractive_index(bk7, 656.2725)) ==
          doctest::Approx(64.12995).epsilon(1e-5));
    // Powers checked by hand, and a Sellmeier series with a constant: fused silica of Malitson
    // 1965.
    const Glass square{PolynomialGlass{{2, 0.01}, {0, -2}}, ""};
    CHECK(refractive_index(square, 500) == doctest::Approx(std::sqrt(2.04)).epsilon(1e-14));
    const Glass silica{
        SellmeierGlass{{0.6961663, 0.4079426, 0.8974794},
                       {0.0684043 * 0.0684043, 0.1162414 * 0.1162414, 9.896161 * 9.896161}},
        ""};
    CHECK(refractive_index(silica, 587.5618) == doctest::Approx(1.45846).epsilon(3e-6));
    const Glass shifted{SellmeierGlass{{1}, {0}, 0.25}, ""};
    CHECK(refractive_index(shifted, 600) == doctest::Approx(1.5).epsilon(1e-14));
}

TEST_CASE("air, vacuum and water: what is relative to what") {
    // Standard tables: air of 15 C has n - 1 = 2.7726e-4 at 589 nm (Ciddor 1996, table 1).
    CHECK((air_index(589.3) - 1) * (1 + 3.4785e-3 * 5) ==
          doctest::Approx(2.7716e-4).epsilon(1e-3));
    CHECK(refractive_index(vacuum(), 550) == 1 / air_index(550));
    CHECK_FALSE(is_air(vacuum()));
    CHECK(is_air(Glass{ConstantIndex{1}, "air"}));
    // Water of 20 C at the D line: 1.33299 against air (Handbook of Chemistry and Physics).
    CHECK(refractive_index(water(), 589.3) == doctest::Approx(1.33299).epsilon(1e-5));
    CHECK(refractive_index(water(), 589.3) * air_index(589.3) ==
          doctest::Approx(1.33335).epsilon(1e-5));
    check_glass(water(), "water");
    check_glass(vacuum(), "vacuum");
}

TEST_CASE("absorption: nodes, logarithm between them, constant beyond") {
    const double tau400 = 0.9, tau440 = 0.99, thickness = 10;
    Glass g{ConstantIndex{1.5}, "", {{400, 440}, {-std::log(tau400) / 10, -std::log(tau440) / 10}}};
    const auto tau = [&](double nm) {
        return std::exp(-thickness * absorption_per_mm(g, nm));
    };
    CHECK(tau(400) == doctest::Approx(tau400).epsilon(1e-14));
    CHECK(tau(420) == doctest::Approx(std::sqrt(tau400 * tau440)).epsilon(1e-14));
    CHECK(tau(440) == doctest::Approx(tau440).epsilon(1e-14));
    CHECK(tau(380) == doctest::Approx(tau400).epsilon(1e-14));
    CHECK(tau(700) == doctest::Approx(tau440).epsilon(1e-14));
    CHECK(absorption_per_mm(water(), 500) == 0);
    g.absorption.per_mm[0] = -1;
    CHECK_THROWS_WITH_AS(check_glass(g, "x"), doctest::Contains("absorption"), Error);
    g.absorption.per_mm.pop_back();
    CHECK_THROWS_AS(check_glass(g, "x"), Error);
}
