// The asking end of an edge: the one place where a node meets whoever answers it.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"

namespace lightnet {

/// Answers questions about light, by a call, from another thread or from another host: the asker can't tell.
/// Belongs to one place and is used by its thread only.
class Port {
public:
    /// Names an ask that has begun. 0: it is answered already.
    using Ticket = std::uint64_t;

    virtual ~Port() = default;
    /// Starts to ask. `questions` and `answers` (questions.size() × width, one question's colours side by side) must
    /// stay where they are until finish() has returned or thrown.
    virtual Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) = 0;
    /// Returns when the answers are there. Throws Error when there will be none.
    virtual void finish(Ticket ticket) = 0;
    /// Gives an ask up; its answers will not be written. For unwinding.
    virtual void abandon(Ticket ticket) noexcept = 0;
};

}  // namespace lightnet
