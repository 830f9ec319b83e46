// The end of work that nobody wants any more.
#pragma once

#include <atomic>

namespace lightnet {

/// Thrown out of work, or of a wait, that is no longer wanted. Nothing but the end of that work should catch it.
struct Cancelled {};

// DECISIONS: unwanted-by-thread
/// Ends this thread's work when nobody wants it any more: throws Cancelled. Costs next to nothing; whoever may compute
/// for more than a tenth of a second calls it now and then. Work that asks or traces rays does so by that.
void end_if_unwanted();
/// Does nobody want this thread's work any more? For those who must not throw.
bool is_unwanted();

/// Until the end of a block, work of this thread is unwanted once `stop` is set. Null: it is wanted, come what may.
class LookingAt {
public:
    explicit LookingAt(const std::atomic<bool>* stop);
    ~LookingAt();
    LookingAt(const LookingAt&) = delete;
    LookingAt& operator=(const LookingAt&) = delete;

    /// What this thread looks at now, for threads that work for it.
    static const std::atomic<bool>* now();

private:
    const std::atomic<bool>* before_;
};

}  // namespace lightnet
