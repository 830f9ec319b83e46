// Infinite numbers, and what is no number, among many questions or answers.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"

namespace lightnet {

/// Have all of them finite numbers, and are all about surfaces? Any thread.
bool are_plain(std::span<const Query> questions);
/// How many have a channel that is infinite or no number. Any thread.
std::uint64_t not_finite_among(std::span<const Rgb> answers);

}  // namespace lightnet
