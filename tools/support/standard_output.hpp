// Standard output that is checked: what a program prints is there, or its exit code says that it isn't.
#pragma once

#include <memory>
#include <string>

namespace lightnet {

/// Where the program was started without one of its three standard descriptors, no file that it opens takes that
/// number: what is meant for people would be written into it. For the start of a program.
void keep_standard_descriptors();

/// Stands behind std::cout while it lives, and remembers what became of all that was printed. One for a program.
class StandardOutput {
public:
    StandardOutput();
    ~StandardOutput();
    StandardOutput(const StandardOutput&) = delete;
    StandardOutput& operator=(const StandardOutput&) = delete;

    /// Why what was printed so far isn't all there: "No space left on device". "": it is, or whoever reads it has
    /// closed the pipe and wants no more.
    std::string trouble();
    /// From now on, as if nothing had been lost.
    void forgive();
    /// The exit code of `program`, which has printed all that it had to: `code`, or that of a failure where it isn't
    /// there, which is said on standard error.
    int end(int code, const std::string& program);

private:
    class Bytes;
    std::unique_ptr<Bytes> bytes_;
};

}  // namespace lightnet
