#include "optics/expansion/monomials.h"

#include <memory>

namespace dg {

Monomials::Monomials(int degree) : degree_(degree) {
    const int base = degree + 1;
    place_ = {base * base * base, base * base, base, 1};
    at_code_.assign(std::size_t(base) * place_[0], -1);
    for (int g = 0; g <= degree; ++g) {
        for (int a = g; a >= 0; --a)
            for (int b = g - a; b >= 0; --b)
                for (int c = g - a - b; c >= 0; --c) {
                    const int d = g - a - b - c;
                    const int code = a * place_[0] + b * place_[1] + c * place_[2] + d;
                    at_code_[code] = std::int16_t(exponents_.size());
                    exponents_.push_back({a, b, c, d});
                    code_.push_back(code), degree_of_.push_back(g);
                }
        end_.push_back(count());
    }
}

int Monomials::first_variable(int i) const {
    int v = 0;
    while (exponents_[i][v] == 0) ++v;
    return v;
}

const Monomials& Monomials::of(int degree) {
    static const auto all = [] {
        std::array<std::unique_ptr<const Monomials>, kMaxSeriesDegree + 1> made;
        for (int g = 0; g <= kMaxSeriesDegree; ++g) made[g].reset(new Monomials(g));
        return made;
    }();
    return *all.at(degree);
}

}  // namespace dg
