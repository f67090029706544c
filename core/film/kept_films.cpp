#include "film/kept_films.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "film/film.h"

namespace dg {
namespace {

std::mutex guard;
int keepers = 0;
Film* kept = nullptr;   // never destroyed at exit, when other globals may be gone

}  // namespace

KeptFilms::KeptFilms() {
    const std::lock_guard lock(guard);
    ++keepers;
}

KeptFilms::~KeptFilms() {
    std::unique_ptr<Film> last;   // destroyed after the lock
    const std::lock_guard lock(guard);
    if (--keepers == 0) last.reset(std::exchange(kept, nullptr));
}

std::size_t KeptFilms::bytes() {
    const std::lock_guard lock(guard);
    return kept ? kept->state_bytes() : 0;
}

std::size_t Film::state_bytes() const {
    std::size_t all = 0;
    stores_.for_each([&](const auto&, const auto& store) { all += store.bytes(); });
    return all;
}

std::unique_ptr<Film> Film::take_kept(const FilmLayout& layout) {
    constexpr std::size_t kSmall = 16;   // a film smaller than the kept film by this factor, as of a pilot, frees nothing
    std::unique_ptr<Film> found;
    Stores ended;   // destroyed after the lock
    const std::lock_guard lock(guard);
    if (!kept) return nullptr;
    const std::size_t needed = pixel_bytes(layout) * layout.pixels();
    if (kept->layout_ == layout || needed * kSmall >= kept->state_bytes()) found.reset(std::exchange(kept, nullptr));
    if (found && found->layout_ == layout) return found;
    if (found) ended = std::exchange(found->stores_, {});   // so that it is not kept again
    return nullptr;
}

Film::~Film() {
    if (of<Layer::sums>().empty()) return;   // moved from, or given up
    std::unique_ptr<Film> before;   // both destroyed after the lock
    Stores ended;
    const std::lock_guard lock(guard);
    if (keepers == 0 || (kept && kept->state_bytes() >= state_bytes())) return;
    before.reset(std::exchange(kept, new Film(std::move(*this))));
    if (before) ended = std::exchange(before->stores_, {});   // so that it is not kept in turn
    kept->stores_.for_each([](const auto&, auto& store) { store.release_spare(); });
}

void Film::clear() {
    stores_.for_each([](const auto&, auto& store) { store.clear(); });
    std::ranges::fill(row_locks_, 0u);
}

}  // namespace dg
