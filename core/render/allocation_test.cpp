// allocation_test.cpp -- out of memory: if any allocation of set-up, of a pass or of reading a film fails, one
// exception is thrown, nothing leaks, and the next render is bit-identical.
//
// The test replaces the allocator by one that fails once, at the n-th allocation after it is armed.
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "math/error.h"
#include "render/flare/flare_scenes.h"

namespace {

std::atomic<std::int64_t> left_until_failure{-1};   // below 0: none
std::atomic<std::int64_t> live{0};                  // blocks not yet freed

void* allocate(std::size_t size, std::size_t alignment) {
    if (left_until_failure.load(std::memory_order_relaxed) >= 0 && left_until_failure.fetch_sub(1) == 0) return nullptr;
    ++live;
    size = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
    return std::aligned_alloc(alignment, size);
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
    if (void* const p = allocate(size, alignment)) return p;
    throw std::bad_alloc();
}

void release(void* p) noexcept {
    if (p) --live;
    std::free(p);
}

constexpr std::size_t kPlain = alignof(std::max_align_t);

}  // namespace

void* operator new(std::size_t n) { return allocate_or_throw(n, kPlain); }
void* operator new[](std::size_t n) { return allocate_or_throw(n, kPlain); }
void* operator new(std::size_t n, std::align_val_t a) { return allocate_or_throw(n, std::size_t(a)); }
void* operator new[](std::size_t n, std::align_val_t a) { return allocate_or_throw(n, std::size_t(a)); }
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return allocate(n, kPlain); }
void* operator new[](std::size_t n, const std::nothrow_t&) noexcept { return allocate(n, kPlain); }
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { release(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { release(p); }

namespace dg {
namespace {

/// Arms the failure of an allocation during its lifetime.
class Failing {
  public:
    explicit Failing(std::int64_t at) { left_until_failure = at; }
    ~Failing() { left_until_failure = -1; }
    /// Whether the allocation has failed.
    static bool failed() { return left_until_failure < 0; }
};

Material window() {
    GltfMaterial m = plain(0.2f, {0.8f, 0.9f, 0.8f});
    m.transmission = 0.8f;
    return {"window", m};
}

/// Renders a table with a glass ball, a window and lamps through an exact lens, from the description to the picture.
std::vector<float> whole_render(double flare) {
    World world;
    world.add(1, {"glass", DielectricMaterial{.ior = 1.5f}}, placed({0, 0.15f, 0}, 0.12f));
    world.add(0, window(), placed({0.1f, 0.2f, 0.3f}, 0.2f));
    world.add(1, {"lamp", plain(), {8, 7, 6}}, placed({0.3f, 0.4f, -0.1f}, 0.03f));
    const auto scene = world.light(kLamp).scene();
    const Camera camera = flare > 0 ? camera_with(test::tessar()) : exact();
    RenderSettings s = settings(3, flare);
    s.sensor = {8, 6, 24, 18, {0, 0}};
    s.threads = 2, s.sample_end = 2;
    if (flare == 0) s.light = {60, 60};
    Film film(FilmLayout{.width = 8, .height = 6,
                         .layers = {Layer::aovs, {Layer::splats, flare == 0}, {Layer::flare, flare > 0},
                                    Layer::coverage, Layer::objects}});
    render(*scene, camera, film, s, nullptr);
    const LayerState words = film.state("objects");
    Film other(film.layout());
    other.set_state("objects", words.bytes);
    other.merge(film);
    return other.mean_xyz();
}

/// Next allocation to fail after `at`: consecutive at first, then increasingly sparse. DG_ALLOCATIONS=1000 tests nearly
/// all allocations.
std::int64_t next(std::int64_t at) {
    static const char* const more = std::getenv("DG_ALLOCATIONS");
    static const std::int64_t dense = more ? std::atoi(more) : 12;
    return at + 1 + at / dense;
}

void fail_everywhere(double flare) {
    const std::vector<float> wanted = whole_render(flare);   // fills caches
    std::int64_t failures = 0;
    for (std::int64_t at = 0;; at = next(at)) {
        const std::int64_t before = live;
        bool caught = false, complete = false;
        {
            const Failing failing(at);
            try {
                complete = whole_render(flare) == wanted;
            } catch (const std::bad_alloc&) {
                caught = true;
            } catch (const Error& error) {   // from Embree's allocations
                caught = std::string(error.what()).find("out of memory") != std::string::npos;
            }
            if (!Failing::failed()) {
                CHECK(complete);
                break;
            }
        }
        ++failures;
        INFO("allocation ", at);
        CHECK((caught || complete));   // a library may handle the failure itself
        CHECK(live - before < 400);    // no scene or film leaks; threads keep some buffers
    }
    CHECK(failures > 60);
    CHECK(whole_render(flare) == wanted);
}

}  // namespace

TEST_CASE("any allocation may fail: of a scene, of light paths and objects") { fail_everywhere(0); }

TEST_CASE("any allocation may fail: of a lens's ghosts") { fail_everywhere(300); }

}  // namespace dg
