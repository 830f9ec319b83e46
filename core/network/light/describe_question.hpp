// Questions in words, for messages about what went wrong.
#pragma once

#include <string>
#include <vector>

#include "core/base/query.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

/// "question at instance 2, shape 7, primitive 12, uv (0.25, 0.5), sample 3 of stream 0x1f, depth 1"
std::string describe(const Query& query);
/// "tile 32x16 at pixel (64, 96), samples 16 to 31"
std::string describe(const Tile& tile);

/// One question, or how many and the first.
template <class Question>
std::string describe(const std::vector<Question>& questions) {
    if (questions.size() == 1) return describe(questions.front());
    return "bundle of " + std::to_string(questions.size()) + ", from the " + describe(questions.front()) + " on";
}

}  // namespace lightnet
