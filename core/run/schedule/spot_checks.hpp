// The random choice of answers that are asked for a second time, of another host.
#pragma once

#include <cstdint>
#include <random>

#include "core/base/math/random.hpp"

namespace lightnet {

/// A part of all work, chosen so that nobody who does not know the secret can tell what is chosen. Of n answers of a
/// host, of which it falsifies the part q, one is found with the probability 1 - (1 - part * q)^n at least.
class SpotChecks {
public:
    SpotChecks() = default;
    /// `millionths` of all work; `secret`: 64 random bits that no answerer learns.
    SpotChecks(std::uint32_t millionths, std::uint64_t secret) : millionths_(millionths), secret_(secret) {}

    bool any() const { return millionths_ > 0; }
    /// Whether the next piece of work is chosen.
    bool next() { return any() && child(secret_, 0, count_++) % 1'000'000 < millionths_; }

private:
    // No number of what is computed depends on it.
    std::uint32_t millionths_ = 0;
    std::uint64_t secret_ = 0, count_ = 0;
};

/// 64 random bits of this process, which nobody else can guess.
inline std::uint64_t secret_number() {
    std::random_device device;
    return (std::uint64_t{device()} << 32) | device();
}

}  // namespace lightnet
