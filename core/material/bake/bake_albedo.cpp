// bake_albedo.cpp -- writes the tables of baked.h as C++. The build runs it: bake_albedo FILE.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "material/bake/quadrature.h"

namespace dg {
namespace {

/// Writes constants to the bit.
class Source {
  public:
    explicit Source(const char* path) : out_(path, std::ios::binary) {
        out_ << "#include \"material/baked.h\"\n\nnamespace dg::baked {\n\n";
    }

    void add(const char* name, const GgxAlbedo& t) { add("GgxAlbedo", name, t.values, t.means); }
    void add(const char* name, const IndexedAlbedo& t) { add("IndexedAlbedo", name, t.values, t.means); }
    void add(const char* name, const CharlieAlbedo& t) { add("CharlieAlbedo", name, t.values); }

    /// Whether all numbers are finite, and written.
    bool finish() {
        out_ << "}  // namespace dg::baked\n";
        out_.close();
        return finite_ && out_;
    }

  private:
    template <typename... Members>
    void add(const char* type, const char* name, const Members&... members) {
        out_ << "constinit const " << type << ' ' << name << "{";
        (write(members), ...);
        out_ << "};\n\n";
    }
    void write(float value) {
        char text[32];
        std::snprintf(text, sizeof text, "%af,", static_cast<double>(value));
        out_ << text;
        finite_ = finite_ && std::isfinite(value);
    }
    void write(LobeAlbedo a) {
        out_ << '{';
        for (int lane = 0; lane < kWavelengths; ++lane) write(a[lane]);
        out_ << "},";
    }
    template <typename T, std::size_t kCount>
    void write(const T (&values)[kCount]) {
        out_ << "{\n";
        for (const T& value : values) write(value);
        out_ << "},";
    }

    std::ofstream out_;
    bool finite_ = true;
};

}  // namespace
}  // namespace dg

int main(int count, char** arguments) {
    using namespace dg;
    if (count != 2) {
        std::cerr << "bake_albedo: wanted the name of a file to write\n";
        return 2;
    }
    Source source(arguments[1]);
    source.add("ggx", bake::ggx());
    source.add("charlie", bake::charlie());
    source.add("glass_ggx", bake::glass(Distribution::ggx));
    source.add("glass_beckmann", bake::glass(Distribution::beckmann));
    source.add("caught_ggx", bake::caught(Distribution::ggx));
    source.add("caught_beckmann", bake::caught(Distribution::beckmann));
    if (source.finish()) return 0;
    std::cerr << "bake_albedo: cannot write " << arguments[1] << ", or a number is not finite\n";
    return 1;
}
