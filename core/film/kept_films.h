// kept_films.h -- memory of films that ended, for the next ones.
#pragma once
#include <cstddef>

namespace dg {

/// While one lives, the memory of a film that ends waits for the next film of the same layout, as new memory costs time:
/// the system clears it page by page. A film of about its size, or larger, of another layout ends the wait.
class KeptFilms {
  public:
    /// Memory that waits.
    static std::size_t bytes();
    KeptFilms();
    ~KeptFilms();
    KeptFilms(const KeptFilms&) = delete;
    KeptFilms& operator=(const KeptFilms&) = delete;
};

}  // namespace dg
