#include "camera/kept/fit_state.h"

#include "camera/kept/archive.h"
#include "math/error.h"

namespace dg {

// Structured bindings list all members, as in aim_state.cpp: a new member fails to compile until
// this file handles it.

template <typename A, Either<FitTerm> T>
void describe(A& a, T& t) {
    a(t[0], t[1], t[2], t[3], t[4]);
}
template <typename A, Either<FitFunctions> T>
void describe(A& a, T& f) {
    auto& [count, terms, coefficients] = f;
    a(count, terms, coefficients);
}
template <typename A, Either<FitBlock> T>
void describe(A& a, T& b) {
    auto& [x, y] = b;
    a(x, y);
}
template <typename A, Either<FitSegment> T>
void describe(A& a, T& s) {
    auto& [u_low, u_high, bend, direction, points, light] = s;
    a(u_low, u_high, bend, direction, points, light);
}
template <typename A, Either<FitPupil> T>
void describe(A& a, T& p) {
    auto& [by_film, by_slope, shift] = p;
    a(by_film, by_slope, shift);
}
template <typename A, Either<FitInverse> T>
void describe(A& a, T& i) {
    auto& [direction, pupil, rays] = i;
    a(direction, pupil, rays);
}
template <typename A, Either<FitMount> T>
void describe(A& a, T& m) {
    auto& [surface, radius, inner] = m;
    a(surface, radius, inner);
}
template <typename A, Either<FitDeviation> T>
void describe(A& a, T& d) {
    auto& [rms, max] = d;
    a(rms, max);
}
template <typename A, Either<FitErrorZone> T>
void describe(A& a, T& z) {
    auto& [low, high, rays, direction, film, iris, mount, transmittance, lost, leaked] =
        z;
    a(low, high, rays, direction, film, iris, mount, transmittance, lost, leaked);
}
template <typename A, Either<LensFit> T>
void describe(A& a, T& f) {
    auto& [lens, degree, symmetry, scale, film, film_center, film_half, pupil,
           entrance_pupil_z, front_z, front_curvature, iris_radius, iris_outer, mounts,
           segments, inverse, error] = f;
    a(lens, degree, symmetry.axial, symmetry.mirror_x, symmetry.mirror_y, scale.offset,
      scale.scale, film.center, film.x, film.y, film_center, film_half, pupil,
      entrance_pupil_z, front_z, front_curvature, iris_radius, iris_outer, mounts,
      segments, inverse, error.all, error.zones);
}

namespace {

constexpr std::size_t kDigest = 8;

std::string digest(std::string_view bytes) {
    const std::uint64_t h = hash_bytes(bytes, 3);
    return {reinterpret_cast<const char*>(&h), kDigest};
}

}  // namespace

std::string to_bytes(const LensFit& fit) {
    ByteWriter w;
    w(fit);
    return digest(w.bytes) + w.bytes;
}

std::optional<LensFit> fit_from_bytes(const std::string& bytes) {
    if (bytes.size() < kDigest) return std::nullopt;
    const std::string_view rest = std::string_view(bytes).substr(kDigest);
    if (bytes.compare(0, kDigest, digest(rest)) != 0) return std::nullopt;
    LensFit fit;
    ArchiveReader r(rest);
    r(fit);
    if (!r.ok || !r.rest.empty()) return std::nullopt;
    try {
        check_lens_fit(fit);
    } catch (const Error&) {
        return std::nullopt;
    }
    return fit;
}

}  // namespace dg
