// Graph files, read by a process of their own for one that has threads.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lua/load_graph.hpp"

namespace lightnet {

/// Evaluating Lua forks, which a process with threads must not: of them its child would have only the locks. So this
/// forks once, while there are none, and that child, which stays alone, evaluates whatever it is asked for later. It
/// ends with this, or with its parent.
class GraphReader {
public:
    /// Call it before threads are started. Throws Error where there is no process or socket for it.
    GraphReader();
    ~GraphReader();
    GraphReader(const GraphReader&) = delete;
    GraphReader& operator=(const GraphReader&) = delete;

    /// As read_graph(). One thread at a time. Throws UserError, also when the child is gone. What it gave last is given
    /// again, without evaluating anything, where a graph without mistakes hangs on this file and the options alone, and
    /// both are as they were.
    GraphFile read(const std::string& file, const LuaOptions& options);

private:
    struct Child;
    struct Last {
        std::string question, text;  // with the options; all of the file
        GraphFile read;
    };
    std::unique_ptr<Child> child_;
    std::optional<Last> last_;
};

}  // namespace lightnet
