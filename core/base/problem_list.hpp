// A bounded list of problems, of something that a stranger may have made.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

/// Collects problems. After the first hundred they are only counted, and long texts are cut.
class ProblemList {
public:
    static constexpr std::size_t most = 100;
    static constexpr std::size_t longest = 800;  // bytes of a text

    void add(SourceLine where, std::string what);
    /// There were so many more that nobody has added.
    void leave_out(std::size_t more) { untold_ += more; }
    /// Those that are told, and "and 7 more" where others are not. Leaves the list empty.
    std::vector<Problem> take();

private:
    std::vector<Problem> told_;
    std::size_t untold_ = 0;
};

/// The text, or so much of it as makes `most` bytes with "…" behind it. Never cuts a letter of UTF-8 into pieces.
std::string shortened(std::string text, std::size_t most);

}  // namespace lightnet
