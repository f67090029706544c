// film_noise.cpp -- variance of the picture, out of exact sums.
//
// Variance of the mean of n samples s: (sum s^2 - (sum s)^2 / n) / (n (n - 1)). It assumes independent samples;
// stratified samples scatter less, so the estimate is conservative. A splat adds its value and its square but no count:
// the splats of a pixel are a compound Poisson process, with the expected sum of squares as variance. Splats of one light
// path in one pixel would be correlated: the caller adds them up first.
#include <algorithm>

#include "film/film.h"

namespace dg {

Film::Estimate Film::estimate(std::size_t i) const {
    const CameraSums& p = of<Layer::sums>()[i];
    const Plane<XyzSums>& catchers = of<Layer::catchers>();
    Vec3d xyz{p.xyz[0].value(), p.xyz[1].value(), p.xyz[2].value()}, all = sum_xyz(i);
    // Variance of light + with - without (camera_light.h), relative to all visible light.
    for (int k = 0; k < 3 && !catchers.empty(); ++k) {
        const double with = catchers[2 * i].xyz[k].value();
        xyz[k] += with - catchers[2 * i + 1].xyz[k].value();
        all[k] += with;
    }
    const double n = p.count;
    Estimate e;
    for (int k = 0; k < 3; ++k) {
        const double own = dot(to_double(rgb_from_xyz_[k]), xyz);
        e.sum[k] = dot(to_double(rgb_from_xyz_[k]), all);
        const double scatter = p.rgb_squares[k].value() - own * own / n;
        e.variance[k] = n < 2 ? 0 : std::max(0.0, scatter / (n * (n - 1)));
        for (const Plane<ColorSums>* emitter_layer : {&of<Layer::splats>(), &of<Layer::flare>()})
            if (!emitter_layer->empty() && n > 0) e.variance[k] += (*emitter_layer)[i].rgb_squares[k].value() / (n * n);
    }
    return e;
}

std::vector<float> Film::variance_rgb() const {
    std::vector<float> variance;
    variance.reserve(3 * layout_.pixels());
    for (std::size_t i = 0; i < layout_.pixels(); ++i) {
        const Estimate e = estimate(i);
        for (double v : e.variance) variance.push_back(float(v));
    }
    return variance;
}

std::vector<float> Film::relative_variance(float dark) const {
    std::vector<float> relative;
    relative.reserve(layout_.pixels());
    for (std::size_t i = 0; i < layout_.pixels(); ++i) {
        const Estimate e = estimate(i);
        const double n = std::max(1u, of<Layer::sums>()[i].count);
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            sum += e.variance[k] / (e.sum[k] * e.sum[k] / (n * n) + dark);
        relative.push_back(float(sum * n / 3));
    }
    return relative;
}

}  // namespace dg
