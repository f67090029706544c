// fuzz_film.cpp -- the words of a film as a file may have them: read, drawn into, merged.
#include "film/film.h"
#include "input.h"
#include "math/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace dg;
    FuzzInput in(data, size);
    FilmLayout layout{in.below(4), in.below(4), in.below(3), in.below(3), {{Layer::aovs, in.flag()}}};
    try {
        Film film(layout), other(layout);
        for (Film* each : {&film, &other})
            for (const std::string& part : each->state_parts()) {
                std::vector<std::byte> bytes(each->state(part).bytes.size() + (in.below(64) == 63));
                for (std::byte& b : bytes) b = std::byte(in.raw<std::uint8_t>());
                each->set_state(part, bytes);
            }
        for (int i = 0; i < 4; ++i) {
            const int x = in.below(5), y = in.below(5);
            film.add(x, y, in.raw<std::uint32_t>(), in.vec3());
            film.add_shared(x, y, in.raw<std::uint32_t>(), Wavelengths::sample(0.5f), {.light = in.number()});
            AovSample aov;
            aov.depth = in.number();
            film.add_aov(x, y, i, aov);
            film.count(x, y);
        }
        film.merge(other);
        film.mean_xyz();
        film.variance_rgb();
        film.bad_samples();
        film.object_ids();
        for (const AovChannel& channel : kAovChannels) film.aov(channel.name);
    } catch (const Error&) {
    }
    return 0;
}
