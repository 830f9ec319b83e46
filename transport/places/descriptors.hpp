// The number of files and sockets that this process may have open.
#pragma once

#include <cstddef>
#include <string>

namespace lightnet {

/// Raises the limit as far as the system lets us. For the start of a program.
void raise_descriptor_limit();
/// How many may still be opened.
std::size_t descriptors_left();
/// ZeroMQ ends the process when it gets none at some places, so it's asked beforehand. Throws Error when fewer than
/// `count` are left, with what `purpose` needs and what would help.
void want_descriptors(std::size_t count, const std::string& purpose);

}  // namespace lightnet
