// Turns in which the addresses of a host are called.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/ip_address.hpp"

namespace lightnet {

/// One after the other, until one answers; who says no is left at once, who says nothing after a while, which gets
/// longer with each round: the line may be slow. Time is an argument.
class AddressTurns {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// All that are known now, in the order in which they are to be tried. Who answers stays, whatever is known.
    void use(const std::vector<IpAddress>& addresses, Time now);
    /// What became of calling due().
    void answered();
    void cut(Time now);
    void refused() { refused_ = true; }
    bool is_answered() const { return answered_; }
    /// The one to be called now; none: no address is known.
    std::optional<IpAddress> due(Time now);
    const std::vector<IpAddress>& all() const { return addresses_; }

private:
    void begin_with(std::size_t at, Time now);

    std::vector<IpAddress> addresses_;
    std::size_t at_ = 0;
    bool answered_ = false, refused_ = false;
    bool waited_ = false;  // in this round, for who said nothing
    Time since_{}, round_begun_{};
    std::chrono::milliseconds patience_{first_patience}, pace_{first_pace};

    static constexpr std::chrono::milliseconds first_patience{500}, longest_patience{8000};  // with who says nothing
    static constexpr std::chrono::milliseconds first_pace{50}, longest_pace{1000};  // of rounds, if all say no at once
};

}  // namespace lightnet
