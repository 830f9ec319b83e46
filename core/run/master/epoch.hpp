// Tells the replies to one asker from those to the one before it.
#pragma once

#include <cstdint>

#include "core/base/error.hpp"

namespace lightnet {

/// Which of the masters that follow each other on one carrier is at work. Its channels carry the epoch in their upper
/// bits, so that a late reply to an earlier master, whose channels had the same numbers, is not taken for one to it.
/// After the last epoch comes the first again: by then no reply is as late as that.
// DECISIONS: epochs-begin-again
class Epoch {
public:
    static constexpr unsigned channel_bits = 20;  // of a marked channel; the bits above them are the epoch's
    static constexpr std::uint32_t count = (1u << (32 - channel_bits)) - 1;
    static constexpr std::uint32_t most_channels = 1u << channel_bits;

    /// The number of the epoch, below `count`.
    std::uint32_t number() const { return number_; }
    void begin_next() { number_ = (number_ + 1) % count; }

    /// Throws Error when a master has opened more channels than can be told apart.
    std::uint32_t marked(std::uint32_t channel) const {
        if (channel >= most_channels) throw Error("a master has too many channels: places came and went too often");
        return channel | number_ << channel_bits;
    }
    bool has(std::uint32_t marked) const { return marked >> channel_bits == number_; }
    /// A channel that is no master's, but of who leads them all. Below most_channels.
    static constexpr std::uint32_t own(std::uint32_t channel) { return channel | count << channel_bits; }
    static bool is_own(std::uint32_t marked) { return marked >> channel_bits == count; }
    static std::uint32_t channel_of(std::uint32_t marked) { return marked & ((1u << channel_bits) - 1); }

private:
    std::uint32_t number_ = 0;
};

}  // namespace lightnet
