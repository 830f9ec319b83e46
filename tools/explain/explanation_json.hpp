// The explanation of a pixel, for programs.
#pragma once

#include <cstddef>
#include <string>

#include "core/run/assembly/account.hpp"
#include "tools/explain/pixel_account.hpp"

namespace lightnet {

/// "lightnet explanation 1", as docs/schemas/explanation.json has it.
std::string explanation_json(const PixelAccount& account, const std::string& picture, std::size_t most);

/// A question as a line of JSON that loses no bit: asker, asked, question, answer.
std::string question_line(const AskedQuestion& asked, const Graph& graph);
/// Reads it back. `within` is nobody's. Throws Error when it is none, or names nodes that `graph` doesn't have.
AskedQuestion question_of_line(const std::string& line, const Graph& graph);

}  // namespace lightnet
