// kept_films.cpp -- memory of films that ended, for the next ones.
#include <algorithm>
#include <mutex>
#include <utility>

#include "film/film.h"
#include "math/cancel.h"

namespace dg {
namespace {

std::mutex guard;
int keepers = 0;
Film* kept = nullptr;   // never destroyed at exit, when other globals may be gone

template <class T>
void reset(std::vector<T>& all) {
    constexpr std::size_t kStep = 1 << 20;
    for (std::size_t i = 0; i < all.size(); i += kStep) {
        throw_if_cancelled();
        std::fill_n(all.begin() + i, std::min(kStep, all.size() - i), T{});
    }
}

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
    for (const std::string& part : state_parts()) all += state(part).size();
    return all;
}

std::unique_ptr<Film> Film::take_kept(const FilmLayout& layout) {
    constexpr std::size_t kSmall = 16;   // so many films of a pilot render, or more, fit in the memory that is kept
    std::unique_ptr<Film> found;
    const std::lock_guard lock(guard);
    if (!kept) return nullptr;
    const std::size_t needed = pixel_bytes(layout) * std::size_t(layout.width) * std::size_t(layout.height);
    if (kept->layout_ == layout || needed * kSmall >= kept->state_bytes()) found.reset(std::exchange(kept, nullptr));
    if (found && found->layout_ == layout) return found;
    if (found) found->pixels_ = {};   // so that it is not kept again
    return nullptr;
}

Film::~Film() {
    if (pixels_.empty()) return;   // moved from, or given up
    std::unique_ptr<Film> before;  // destroyed after the lock, when another one is kept
    const std::lock_guard lock(guard);
    if (keepers == 0 || (kept && kept->state_bytes() >= state_bytes())) return;
    before.reset(std::exchange(kept, new Film(std::move(*this))));
    if (before) before->pixels_ = {};   // so that it is not kept in turn
    if (kept->objects_) kept->objects_ = std::make_unique<CoverLists>(kept->pixels_.size());
}

void Film::clear() {
    reset(pixels_);
    reset(aovs_);
    reset(splats_);
    reset(flare_);
    reset(halves_);
    reset(coverage_);
    if (objects_) objects_ = std::make_unique<CoverLists>(pixels_.size());
    reset(catchers_);
    reset(row_locks_);
    reset(bands_);
    reset(channels_);
    reset(channel_splats_);
    reset(catcher_channels_);
}

}  // namespace dg
