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
Film* kept = nullptr;   // never destroyed at exit, when other statics may be gone

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

std::unique_ptr<Film> Film::take_kept(const FilmLayout& layout) {
    const std::lock_guard lock(guard);
    if (!kept || kept->layout_ != layout) return nullptr;
    return std::unique_ptr<Film>(std::exchange(kept, nullptr));
}

Film::~Film() {
    if (pixels_.empty()) return;   // moved from
    std::unique_ptr<Film> before;  // destroyed after the lock, when another one is kept
    const std::lock_guard lock(guard);
    if (keepers == 0 || (kept && kept->layout_ == layout_)) return;
    before.reset(std::exchange(kept, new Film(std::move(*this))));
    if (before) before->pixels_ = {};   // so that it is not kept in turn
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
