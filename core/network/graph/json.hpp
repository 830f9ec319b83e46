// Texts of small values, for pipes between processes, and what reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/network/graph/graph.hpp"

namespace lightnet {

/// A graph that is part of a larger text: see graph_from_json() of a text.
Graph graph_from_json(const Json& json);

/// Canonical text of a list of problems. Bytes that aren't UTF-8 are replaced.
std::string to_json(const std::vector<Problem>& problems);
/// Reads it back. Throws Error on anything else.
std::vector<Problem> problems_from_json(std::string_view text);

/// Whether `text` is UTF-8, and so can stand in a graph.
bool is_utf8(std::string_view text);

}  // namespace lightnet
