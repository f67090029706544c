#include "optics/aim/chief_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "optics/first_order/paraxial.h"
#include "optics/lens/lens_error.h"

namespace dg {
namespace {

constexpr int kSide = 13;  // grid nodes per side

/// Solves the 2 x 2 system with matrix columns x, y for the right-hand side v.
Vec2d solve2(Vec2d x, Vec2d y, Vec2d v) {
    const double det = x.x * y.y - y.x * x.y;
    return {(v.x * y.y - y.x * v.y) / det, (x.x * v.y - v.x * x.y) / det};
}

}  // namespace

Vec2d ChiefMap::node(int i) {
    return {2.0 * (i % kSide) / (kSide - 1) - 1, 2.0 * (i / kSide) / (kSide - 1) - 1};
}

std::optional<Vec2d> ChiefMap::iris(Vec2d film, Vec2d m) const {
    return tracer_.to_iris({plane_.at(film_.at(film)), normalize(Vec3d{-m.x, -m.y, -1})}, index_,
                           1e6);
}

/// Newton's method to the centre of the iris; halves steps that lose the ray.
ChiefMap::Local ChiefMap::solve(Vec2d film, Vec2d start) const {
    constexpr double h = 1e-5;
    Local local{start};
    auto here = iris(film, start);
    for (int step = 0; here && step < 20; ++step) {
        Vec2d& m = local.chief;
        const auto mx = iris(film, {m.x + h, m.y}), my = iris(film, {m.x, m.y + h});
        if (!mx || !my) return local;
        const Vec2d by_x = (*mx - *here) * (1 / h), by_y = (*my - *here) * (1 / h);
        local.iris_x = solve2(by_x, by_y, {1, 0}), local.iris_y = solve2(by_x, by_y, {0, 1});
        if (length(*here) < 1e-6) {
            const auto fx = iris({film.x + h, film.y}, m), fy = iris({film.x, film.y + h}, m);
            if (!fx || !fy) return local;
            local.film_x = solve2(by_x, by_y, (*here - *fx) * (1 / h));
            local.film_y = solve2(by_x, by_y, (*here - *fy) * (1 / h));
            local.ok = true;
            return local;
        }
        Vec2d change = solve2(by_x, by_y, *here);
        std::optional<Vec2d> next;
        for (int half = 0; half < 12 && !(next && length(*next) < length(*here)); ++half) {
            next = iris(film, m - change);
            if (!(next && length(*next) < length(*here))) change = change * 0.5;
        }
        m = m - change, here = iris(film, m);
    }
    return local;
}

ChiefMap::ChiefMap(const Tracer& tracer, const FilmPlane& plane, const FilmRectangle& film)
    : tracer_(tracer),
      plane_(plane),
      film_(film),
      index_(tracer.at(kDesignWavelength)),
      nodes_(kSide * kSide) {
    // Solve nodes outward from the centre, each starting from its nearest solved neighbour.
    std::vector<int> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [](int a, int b) {
        return dot(node(a), node(a)) < dot(node(b), node(b)) - 1e-9;
    });
    const Vec3d middle = plane.at(film.center);
    const auto toward = [&](double z) { return Vec2d{middle.x, middle.y} * (1 / (middle.z - z)); };
    std::vector<int> done;
    for (const int i : order) {
        Vec2d start = toward(tracer.vertices().back());
        int nearest = -1;
        for (const int k : done)
            if (nearest < 0 || length(node(k) - node(i)) < length(node(nearest) - node(i)))
                nearest = k;
        if (nearest >= 0) start = nodes_[nearest].at(node(i) - node(nearest), {});
        nodes_[i] = solve(node(i), start);
        if (nearest < 0 && !nodes_[i].ok)  // a cover glass gives no start; use the exit pupil
            nodes_[i] = solve(node(i), toward(first_order(tracer.prescription()).exit_pupil_z));
        if (nodes_[i].ok) {
            done.push_back(i);
        } else if (nearest >= 0) {   // dark node: extrapolate from the neighbour
            nodes_[i] = nodes_[nearest];
            nodes_[i].chief = start, nodes_[i].ok = false;
        }
        if (i == order[0] && !nodes_[i].ok)
            throw LensError(tracer.prescription().name +
                                ": no ray leads from the film's centre to the iris",
                            "lens-no-light");
    }
}

Vec2d ChiefMap::slope(Vec2d film, Vec2d iris) const {
    const auto place = [](double u) {
        const double at = 0.5 * (u + 1) * (kSide - 1);
        return at > 0 ? std::min(at, kSide - 1.0) : 0.0;  // NaN maps to 0
    };
    const double px = place(film.x), py = place(film.y);
    const int x = std::min(int(px), kSide - 2), y = std::min(int(py), kSide - 2);
    Vec2d sum{};
    for (int corner = 0; corner < 4; ++corner) {
        const int cx = x + corner % 2, cy = y + corner / 2, i = cy * kSide + cx;
        const double weight = (1 - std::abs(px - cx)) * (1 - std::abs(py - cy));
        sum = sum + weight * nodes_[i].at(film - node(i), iris);
    }
    return sum;
}

}  // namespace dg
