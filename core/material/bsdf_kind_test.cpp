#include "material/bsdf_kind.h"

#include "material/bsdf.h"

namespace dg {
namespace {

/// A complete BSDF that is black.
struct Complete {
    static constexpr bool kOneLobe = true;
    Evaluation evaluate_with_pdf(Vec3f, Vec3f) const { return {}; }
    Spectrum evaluate(Vec3f, Vec3f) const { return 0.f; }
    float pdf(Vec3f, Vec3f) const { return 0; }
    std::optional<BsdfSample> sample(Vec3f, float, Vec2f) const { return {}; }
    bool is_specular() const { return false; }
    float diffuse_share(Vec3f, Vec3f) const { return 1; }
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    Spectrum straight_transmittance(Vec3f) const { return 0.f; }
    float reversed(Vec3f, Vec3f) const { return 1; }
};

struct NoDensity : Complete {   // lacks the density that MIS needs
    Spectrum evaluate_with_pdf(Vec3f, Vec3f) const { return 0.f; }
};
struct NeverAbsorbs : Complete {
    BsdfSample sample(Vec3f, float, Vec2f) const { return {}; }
};
struct OneNumber : Complete {
    std::optional<BsdfSample> sample(Vec3f, Vec2f) const { return {}; }
};
struct LobesUnknown : Complete {
    void kOneLobe() const {}
};
struct NoSide : Complete {
    void interior() const {}
};
struct NoDeltas : Complete {
    void straight_transmittance() const {}
};
struct OneWay : Complete {   // lacks the reverse direction for light paths
    void reversed() const {}
};
struct Changes : Complete {   // not const: a vertex holds a constant BSDF
    bool is_specular() { return false; }
};
struct Fixed : Complete {   // not assignable
    const float value = 0;
};
struct InMedium : Complete {
    static constexpr bool kInMedium = true;
};

static_assert(BsdfKind<Complete>);
static_assert(!BsdfKind<NoDensity>);
static_assert(!BsdfKind<NeverAbsorbs>);
static_assert(!BsdfKind<OneNumber>);
static_assert(!BsdfKind<LobesUnknown>);
static_assert(!BsdfKind<NoSide>);
static_assert(!BsdfKind<NoDeltas>);
static_assert(!BsdfKind<OneWay>);
static_assert(!BsdfKind<Changes>);
static_assert(!BsdfKind<Fixed>);
static_assert(!BsdfKind<InMedium> && PhaseKind<InMedium> && !PhaseKind<Complete>);
static_assert(!kBsdfKinds<std::variant<DiffuseBsdf, OneWay>>);

}  // namespace
}  // namespace dg
