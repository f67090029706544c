// made_once.h -- lazily created value, shared by all copies of an object.
#pragma once
#include <memory>
#include <mutex>

namespace dg {

/// T may be incomplete at the declaration of a member.
template <typename T>
class MadeOnce {
  public:
    /// Returns the value; calls make() on first use. If make() throws, the next call retries.
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
