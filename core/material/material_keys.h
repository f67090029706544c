// material_keys.h -- materials that change while the shutter is open: numbers are interpolated linearly between keys;
// kind, textures and modes are constant.
#pragma once
#include <memory>
#include <span>

#include "material/material.h"
#include "motion/keyed.h"

namespace dg {

/// Interpolates from a to b. Textures and modes are taken from a; the name is not set. A length that is infinite in
/// only one of both stays constant until the next key.
Material blend(const Material& a, const Material& b, float share);

/// Throws Error for a key that is not a valid material, or differs from the first key in kind, textures or modes.
void validate(std::span<const Material> keys, const std::vector<Texture>& textures);

/// Minimum and maximum of each number over time, for decisions that hold for the whole interval.
struct MaterialRange {
    Material least, most;
};
MaterialRange range_of(const Keyed<Material>& keys);

struct MaterialChange {
    Keyed<Material> keys;
    MaterialRange range;
};

/// Material that is at least as bright as at any time, with the texture transforms of the first key.
Material brightest(const Keyed<Material>& keys, const MaterialRange& range);

/// Ways in which light may pass unrefracted at some time of the interval.
Clear clearness(const MaterialRange& range);

/// A material at a time; refers to the scene's material if it does not change, without a copy.
class MaterialAt {
  public:
    explicit MaterialAt(const Material* still) : now_(still) {}
    MaterialAt(const Keyed<Material>& keys, float time);
    MaterialAt(const MaterialAt&) = delete;
    MaterialAt& operator=(const MaterialAt&) = delete;
    operator const Material&() const& { return *now_; }  // NOLINT: implicit
    operator const Material&() const&& = delete;         // it must outlive the reference

  private:
    struct Delete {  // not inlined, which would slow down the loop over vertices
        void operator()(const Material* m) const;
    };
    const Material* now_;
    std::unique_ptr<const Material, Delete> own_;
};

/// A part of a mixture at a time.
inline MaterialAt part_at(const MixPart& part, float time) {
    if (part.change) return MaterialAt(part.change->keys, time);
    return MaterialAt(part.still);
}

}  // namespace dg
