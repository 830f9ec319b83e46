#include "core/base/unwanted.hpp"

#include <utility>

namespace lightnet {
namespace {

thread_local const std::atomic<bool>* looked_at = nullptr;

}  // namespace

bool is_unwanted() { return looked_at && looked_at->load(std::memory_order_relaxed); }

void end_if_unwanted() {
    if (is_unwanted()) throw Cancelled{};
}

LookingAt::LookingAt(const std::atomic<bool>* stop) : before_(std::exchange(looked_at, stop)) {}
LookingAt::~LookingAt() { looked_at = before_; }
const std::atomic<bool>* LookingAt::now() { return looked_at; }

}  // namespace lightnet
