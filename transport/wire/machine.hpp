// A description of a machine, for display: nothing that is computed depends on it.
#pragma once

#include <cstdint>
#include <string>

#include "transport/wire/packet.hpp"

namespace lightnet {

/// A value.
struct Machine {
    std::string name;          // of the host
    std::string cpu;           // model
    std::string isa;           // the widest that Embree would choose here
    std::string version;       // of lightnetd
    std::uint64_t cores = 0;   // that it may use
    std::uint64_t memory = 0;  // likewise; bytes
    friend bool operator==(const Machine&, const Machine&) = default;
};

/// This one.
Machine this_machine();

/// Tells one life of a daemon from the next; never 0. Nothing that is computed depends on it.
std::uint64_t process_number();

/// As fields of a control packet, and back.
void set(packet::Fields& fields, const Machine& machine);
Machine machine_from(const packet::Fields& fields);

}  // namespace lightnet
