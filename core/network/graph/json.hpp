// Texts of small values, for pipes between processes, and what reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/network/graph/graph.hpp"

namespace lightnet {

/// A graph that is part of a larger text: see graph_from_json() of a text.
Graph graph_from_json(const Json& json);

/// Canonical text of a list of problems.
std::string to_json(const std::vector<Problem>& problems);
/// Reads it back. Throws Error on anything else.
std::vector<Problem> problems_from_json(std::string_view text);

/// A text as JSON; bytes that are no UTF-8, as in names of old files, as {"bytes": digits}.
JsonTree tree_of_text(const std::string& text);
/// Reads it back. Throws Error on anything else.
std::string text_from_json(const Json& json);

}  // namespace lightnet
