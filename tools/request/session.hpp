// A session, as it is asked for: a graph that is edited while it renders.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

#include "tools/request/graph_edits.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// A value.
struct Session {
    std::string graph;  // its file
    /// The run of the graph as it is now, edited. Called by one thread, while others are there. Throws UserError.
    std::function<RunRequest(const GraphEdits& edits)> request;
    std::optional<WatchAddress> watch;  // where a page is served; none: nowhere
    int edits = 0;                      // descriptor of the lines
    std::ostream* events = nullptr;  // a line of JSON for each thing that happens; null: a sentence on standard error
};

}  // namespace lightnet
