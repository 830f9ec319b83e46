// The surroundings of a node: places, hosts, process and memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/allowance.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {

/// For display, for budgets and for the names of locks: what a node computes must not depend on it. A value; true when
/// it was asked for, as hosts come and go.
struct Whereabouts {
    std::string place = "this thread";       // "tcp://onyx1:7777 place 2"
    std::size_t places = 1, hosts = 1;       // of the run
    std::string process = process_name();    // which places share global variables
    std::uint64_t memory = usable_memory();  // that the process may use, bytes; 0: not known
};

}  // namespace lightnet
