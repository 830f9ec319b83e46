#include "transport/launcher/message_counts.hpp"

namespace lightnet {

bool MessageCounts::lacks_something(const packet::Fields& pong, bool old_line) {
    const Between now{pong.number("line"), pong.number("taken") - pong.number("sent"), pong.number("told") - received_};
    if (old_line) between_.reset();
    if (!between_ || between_->line != now.line) between_ = now;
    return *between_ != now;
}

}  // namespace lightnet
