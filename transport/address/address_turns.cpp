#include "transport/address/address_turns.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

void AddressTurns::begin_with(std::size_t at, Time now) {
    at_ = at;
    since_ = now;
    refused_ = false;
    if (at == 0) round_begun_ = now;
}

void AddressTurns::use(const std::vector<IpAddress>& addresses, Time now) {
    // Name servers give them in another order each time.
    const bool known = addresses.size() == addresses_.size() &&
                       std::is_permutation(addresses.begin(), addresses.end(), addresses_.begin());
    if (answered_ || known) return;
    const auto current = addresses_.empty() ? std::nullopt : std::optional(addresses_[at_]);
    addresses_ = addresses;
    const auto same = current ? std::find(addresses_.begin(), addresses_.end(), *current) : addresses_.end();
    if (same == addresses_.end()) return begin_with(0, now);
    at_ = static_cast<std::size_t>(same - addresses_.begin());
}

void AddressTurns::answered() {
    answered_ = true;
    refused_ = false;
    patience_ = first_patience, pace_ = first_pace;
}

void AddressTurns::cut(Time now) {
    if (!answered_) return;
    answered_ = false;
    since_ = round_begun_ = now;
}

std::optional<IpAddress> AddressTurns::due(Time now) {
    if (addresses_.empty()) return std::nullopt;
    const bool next = !answered_ && (refused_ || now - since_ > patience_);
    if (!next || addresses_.size() == 1) return addresses_[at_];
    waited_ |= !refused_;
    if (at_ + 1 < addresses_.size()) {
        begin_with(at_ + 1, now);
    } else if (now - round_begun_ >= pace_) {
        if (std::exchange(waited_, false)) patience_ = std::min(2 * patience_, longest_patience);
        pace_ = std::min(2 * pace_, longest_pace);
        begin_with(0, now);
    }
    return addresses_[at_];
}

}  // namespace lightnet
