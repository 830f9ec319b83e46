// Refusals of the system to those who want to talk to others.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>

namespace lightnet {

/// An endpoint that is none or is taken, or one line more.
class LineError : public std::runtime_error {
public:
    LineError(int number, const std::string& why) : std::runtime_error(why), number_(number) {}
    /// The process, or the system, has no more descriptors.
    bool out_of_descriptors() const { return number_ == EMFILE || number_ == ENFILE; }

private:
    int number_;  // errno
};

}  // namespace lightnet
