// Tags that only their maker can make.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace lightnet {

/// A message authentication code with a key of its own (HMAC-SHA-512-256), which nobody else knows and which goes with
/// it. Any thread.
class Mac {
public:
    Mac();
    std::string tag(std::string_view text) const;
    /// Is this its tag of that text? Takes as long whichever way it is not.
    bool fits(std::string_view text, std::string_view tag) const;

private:
    std::array<unsigned char, 32> key_{};
};

}  // namespace lightnet
