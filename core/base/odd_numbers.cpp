#include "core/base/odd_numbers.hpp"

#include <bit>

namespace lightnet {
namespace {

// The highest bit is set where it is infinite, or not a number: where no bit of its exponent is 0.
std::uint32_t oddness(float number) {
    constexpr std::uint32_t no_sign = 0x7fffffff, least_exponent = 0x00800000;
    return (std::bit_cast<std::uint32_t>(number) & no_sign) + least_exponent;
}

}  // namespace

// Most are sound, and about surfaces: that is seen without a branch for each number.
// DECISIONS: answers-pass-in-vectors
bool are_plain(std::span<const Query> questions) {
    std::uint32_t odd = 0;
    bool any_in_space = false;
    for (const Query& q : questions) {
        odd |= oddness(q.outgoing.x) | oddness(q.outgoing.y) | oddness(q.outgoing.z) | oddness(q.u) | oddness(q.v);
        any_in_space |= q.is_in_space();
    }
    return odd >> 31 == 0 && !any_in_space;
}

std::uint64_t not_finite_among(std::span<const Rgb> answers) {
    std::uint64_t count = 0;
    for (const Rgb& answer : answers) count += (oddness(answer.r) | oddness(answer.g) | oddness(answer.b)) >> 31;
    return count;
}

}  // namespace lightnet
