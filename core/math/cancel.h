// cancel.h -- cancellation: another thread ends long work of this one.
#pragma once
#include <atomic>
#include <stdexcept>

namespace dg {

/// Thrown by work that was cancelled.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};

/// A request to end work, made once, from any thread.
class CancelToken {
  public:
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> cancelled_{false};
};

/// While it lives, the token (none: nothing) cancels the work of this thread. Threads that help take it over.
class CancelScope {
  public:
    explicit CancelScope(const CancelToken* token) : before_(current_) { current_ = token; }
    ~CancelScope() { current_ = before_; }
    CancelScope(const CancelScope&) = delete;
    CancelScope& operator=(const CancelScope&) = delete;

    /// The token of this thread; null: none.
    static const CancelToken* current() { return current_; }

  private:
    // Threads hold little of their own: the C library ends the process if there is no memory for that.
    inline static thread_local const CancelToken* current_ = nullptr;
    const CancelToken* before_;
};

/// Whether the work of this thread was cancelled.
inline bool is_cancelled() {
    const CancelToken* token = CancelScope::current();
    return token && token->cancelled();
}

/// Ends the work of this thread if it was cancelled. Loops that last longer than a few ms call it.
inline void throw_if_cancelled() {
    if (is_cancelled()) throw Cancelled();
}

}  // namespace dg
