// material_keys.h -- materials that change while the shutter is open: every number goes linearly
// from key to key; kind, textures and modes stay.
#pragma once
#include <memory>
#include <span>

#include "material/material.h"
#include "motion/keyed.h"

namespace dg {

/// `share` of the way from a to b. Textures and modes are those of a, and nobody asks it for its name.
/// A length that is infinite at one end only stays as it is until the next key.
Material blend(const Material& a, const Material& b, float share);

/// Throws Error for a key that is no material by itself (validate), or is of another kind, has other
/// textures or other modes than the first.
void validate(std::span<const Material> keys, const std::vector<Texture>& textures);

/// The least and the most that each number is at any time: what is decided once for the whole
/// interval is decided by these.
struct MaterialRange {
    Material least, most;
};
MaterialRange range_of(const Keyed<Material>& keys);

struct MaterialChange {
    Keyed<Material> keys;
    MaterialRange range;
};

/// Material that is as bright as it ever is, or brighter; its textures lie as they do at the first key.
Material brightest(const Keyed<Material>& keys, const MaterialRange& range);

/// Ways in which light may go straight on through at some time; at one time there may be fewer.
Clear clearness(const MaterialRange& range);

/// A material at one time: the scene's own where it does not change, which costs nothing.
class MaterialAt {
  public:
    explicit MaterialAt(const Material* still) : now_(still) {}
    MaterialAt(const Keyed<Material>& keys, float time);
    MaterialAt(const MaterialAt&) = delete;
    MaterialAt& operator=(const MaterialAt&) = delete;
    operator const Material&() const& { return *now_; }  // NOLINT: it is one
    operator const Material&() const&& = delete;         // it must outlive the reference

  private:
    struct Delete {  // not inlined: the loop over vertices would grow by it, and slow down
        void operator()(const Material* m) const;
    };
    const Material* now_;
    std::unique_ptr<const Material, Delete> own_;
};

/// A part of a mixture at one time.
inline MaterialAt part_at(const MixPart& part, float time) {
    if (part.change) return MaterialAt(part.change->keys, time);
    return MaterialAt(part.still);
}

}  // namespace dg
