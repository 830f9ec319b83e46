// Holds one node's parameters against the schema of its kind.
#pragma once

#include <functional>
#include <string>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Is told what is wrong with the node, without its name.
using Complain = std::function<void(const std::string& what)>;

/// Fills the defaults of `kind` into `node` and complains of all its parameters that don't fit. `graph` is asked for
/// the scenes that they name.
void check_params(Node& node, const Kind& kind, const Graph& graph, const Complain& complain);

/// Can nodes, groups and layers be called so?
bool is_name(const std::string& name);
inline constexpr const char* name_rule = "a name is made of letters, digits and _, at most 64";

/// " (did you mean 'x'?)" or, where nothing is close, " (there is: a, b, c)".
std::string suggest(const std::string& word, const std::vector<std::string>& known);

}  // namespace lightnet
