// cancel.h -- cancellation of long work by another thread.
#pragma once
#include <atomic>
#include <stdexcept>

namespace dg {

/// Thrown by cancelled work.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};

/// Request to stop work; set once, by any thread.
class CancelToken {
  public:
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> cancelled_{false};
};

/// Makes the token (null: none) cancel work of this thread within the scope. Helper threads inherit
/// it.
class CancelScope {
  public:
    explicit CancelScope(const CancelToken* token) : before_(current_) { current_ = token; }
    ~CancelScope() { current_ = before_; }
    CancelScope(const CancelScope&) = delete;
    CancelScope& operator=(const CancelScope&) = delete;

    /// Token of this thread; null: none.
    static const CancelToken* current() { return current_; }

  private:
    // Keep thread-local data small: the C library ends the process when it cannot allocate it.
    inline static thread_local const CancelToken* current_ = nullptr;
    const CancelToken* before_;
};

/// Whether the work of this thread was cancelled.
inline bool is_cancelled() {
    const CancelToken* token = CancelScope::current();
    return token && token->cancelled();
}

/// Throws Cancelled if the work of this thread was cancelled. Call it in loops that take more than
/// a few ms.
inline void throw_if_cancelled() {
    if (is_cancelled()) throw Cancelled();
}

}  // namespace dg
