#include "optics/expansion/system.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "math/error.h"

namespace dg {
namespace {

double inverse_square(double nm) {
    return 1e6 / (nm * nm);
}

std::string listed(const std::vector<double>& nm) {
    std::ostringstream s;
    for (std::size_t i = 0; i < nm.size(); ++i) s << (i ? ", " : "") << nm[i];
    return nm.empty() ? "none" : s.str() + " nm";
}

/// Lagrange weights of the nodes.
std::vector<double> weights(const std::vector<double>& nodes, double nm) {
    std::vector<double> w(nodes.size(), 1);
    const double x = inverse_square(nm);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = 0; j < nodes.size(); ++j)
            if (j != i) {
                const double xi = inverse_square(nodes[i]), xj = inverse_square(nodes[j]);
                w[i] *= (x - xj) / (xi - xj);
            }
    return w;
}

template <typename Make>
PolynomialSystem mapped(const PolynomialSystem& system, Make make) {
    PolynomialSystem r{system.nm, {}};
    for (const RayMap& map : system.maps) r.maps.push_back(make(map));
    return r;
}

}  // namespace

void check(const PolynomialSystem& s) {
    if (s.maps.empty() || s.maps.size() != std::max<std::size_t>(1, s.nm.size()))
        throw input_error("polynomial system", "wavelengths", "one expansion for each",
                          std::to_string(s.maps.size()) + " for " + listed(s.nm));
    for (std::size_t i = 0; i < s.nm.size(); ++i)
        if (!(s.nm[i] > 0 && std::isfinite(s.nm[i])) || (i && !(s.nm[i] > s.nm[i - 1])))
            throw input_error("polynomial system", "wavelengths", "ascending, in nm",
                              listed(s.nm));
}

RayMap PolynomialSystem::at(double wavelength_nm) const {
    if (nm.empty()) return maps.front();
    const auto node = std::ranges::find(nm, wavelength_nm);
    if (node != nm.end()) return maps[node - nm.begin()];
    if (!(wavelength_nm > nm.front() && wavelength_nm < nm.back()))
        throw input_error("polynomial system", "wavelength",
                          nm.size() == 1
                              ? listed(nm) + ", for which it was made"
                              : "a wavelength between " + listed({nm.front(), nm.back()}),
                          listed({wavelength_nm}));
    const std::vector<double> w = weights(nm, wavelength_nm);
    RayMap sum;
    for (std::size_t i = 0; i < nm.size(); ++i)
        for (int o = 0; o < 4; ++o) {
            sum.origin[o] += w[i] * maps[i].origin[o];
            sum.out[o] = sum.out[o] + w[i] * maps[i].out[o];
        }
    return sum;
}

std::vector<double> wavelength_nodes(double from_nm, double to_nm, int count) {
    if (count < 1)
        throw input_error("polynomial system", "wavelengths", "at least one",
                          std::to_string(count));
    if (count == 1) return {0.5 * (from_nm + to_nm)};
    const double a = inverse_square(from_nm), b = inverse_square(to_nm);
    std::vector<double> nm;
    for (int i = 0; i < count; ++i) {
        const double t = 0.5 - 0.5 * std::cos(kPiD * i / (count - 1));
        nm.push_back(1e3 / std::sqrt(a + t * (b - a)));
    }
    nm.front() = from_nm, nm.back() = to_nm;
    return nm;
}

PolynomialSystem compose(const PolynomialSystem& second, const PolynomialSystem& first) {
    if (!second.nm.empty() && !first.nm.empty() && second.nm != first.nm)
        throw input_error("polynomial system", "composition",
                          "systems of the same wavelengths",
                          listed(second.nm) + " after " + listed(first.nm));
    PolynomialSystem r{second.nm.empty() ? first.nm : second.nm, {}};
    for (std::size_t i = 0; i < std::max(second.maps.size(), first.maps.size()); ++i)
        r.maps.push_back(compose(second.maps[second.nm.empty() ? 0 : i],
                                 first.maps[first.nm.empty() ? 0 : i]));
    return r;
}

PolynomialSystem inverse(const PolynomialSystem& system) {
    return mapped(system, [](const RayMap& map) { return inverse(map); });
}

PolynomialSystem truncated(const PolynomialSystem& system, int degree) {
    return mapped(system, [&](const RayMap& map) { return truncated(map, degree); });
}

PolynomialSystem lens_system(const Tracer& tracer, const LensWay& way,
                             const std::vector<double>& nm, int degree) {
    PolynomialSystem system{nm, {}};
    for (const double wavelength : nm)
        system.maps.push_back(lens_map(tracer, tracer.at(wavelength), way, degree));
    check(system);
    return system;
}

}  // namespace dg
