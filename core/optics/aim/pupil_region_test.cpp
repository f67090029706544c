#include "optics/aim/pupil_region.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace dg;

namespace {

/// Half height of the overlap of two unit discs with centres 0 and `shift`, like a front mount and
/// the iris.
double cats_eye(double x, double shift) {
    const double h2 = 1 - std::max(x * x, (x - shift) * (x - shift));
    return h2 > 0 ? std::sqrt(h2) : 0;
}

Outline outline_of(double shift) {
    Outline o = Outline::dark(1.02, 97);
    for (int i = 0; i < o.points(); ++i) o.high[i] = cats_eye(o.x(i), shift), o.low[i] = -o.high[i];
    return o;
}

double cats_eye_area(double shift) {
    return 2 * std::acos(shift / 2) - 0.5 * shift * std::sqrt(4 - shift * shift);
}

}  // namespace

TEST_CASE("columns of equal area hold the whole cat's eye, and little else") {
    for (const double shift : {0.0, 0.4, 1.0, 1.6}) {
        INFO(shift);
        const Outline o = outline_of(shift).joined(outline_of(shift), 0.005);
        const Columns c = cover(o);
        for (int k = 0; k < kColumns; ++k)
            CHECK((c.x[k + 1] - c.x[k]) * (c.high[k] - c.low[k]) * kColumns == doctest::Approx(c.area));
        int outside = 0;
        for (int i = 0; i < 20000; ++i) {
            const double x = -1 + 2 * (i + 0.5) / 20000, h = cats_eye(x, shift);
            if (h > 0 && !(c.contain(x, h) && c.contain(x, -h))) ++outside;
        }
        CHECK(outside == 0);
        CHECK(c.area < (shift > 1.2 ? 1.25 : 1.1) * cats_eye_area(shift));
        CHECK_FALSE(c.contain(-1.2, 0));
        CHECK_FALSE(c.contain(0.5 * shift, 1.1));
    }
}

TEST_CASE("a margin that is missing shows at the rim") {
    const Outline o = outline_of(1.0);   // chords only, without the bulge
    const Columns c = cover(o);
    int outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = -1 + 2 * (i + 0.5) / 20000, h = cats_eye(x, 1.0);
        if (h > 0 && !c.contain(x, h)) ++outside;
    }
    CHECK(outside > 0);
}

TEST_CASE("nothing visible: no columns; a rectangle is itself") {
    CHECK(cover(Outline::dark(1, 97)).area == 0);
    CHECK_FALSE(cover(Outline::dark(1, 97)).contain(0, 0));
    const Columns r = rectangle(-1, 3, -0.5, 0.5);
    CHECK(r.area == doctest::Approx(4));
    CHECK(r.contain(2.9, -0.5));
    CHECK_FALSE(r.contain(2.9, 0.51));
}
