// kept_films.h -- memory of destroyed films, for reuse.
#pragma once
#include <cstddef>

namespace dg {

/// While a KeptFilms exists, the memory of the largest destroyed film is kept for the next film of the same layout: new
/// memory is slow, as the system clears it page by page. A film of another layout frees it, unless it is much smaller.
class KeptFilms {
  public:
    /// Bytes of the kept film.
    static std::size_t bytes();
    KeptFilms();
    ~KeptFilms();
    KeptFilms(const KeptFilms&) = delete;
    KeptFilms& operator=(const KeptFilms&) = delete;
};

}  // namespace dg
