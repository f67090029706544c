// made_once.h -- a value that all copies of an object share: made when one of them first needs it.
#pragma once
#include <memory>
#include <mutex>

namespace dg {

/// T may be incomplete where this is a member.
template <typename T>
class MadeOnce {
  public:
    /// The value; make() makes it, unless that was done. If that throws, the next call tries again.
    template <typename Make>
    const T& get(const Make& make) const {
        const std::scoped_lock lock(shared_->making);
        if (!shared_->value) shared_->value = std::make_shared<const T>(make());
        return *shared_->value;
    }

  private:
    struct Shared {
        std::mutex making;
        std::shared_ptr<const T> value;
    };
    std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace dg
