// The curve of a picture's error against a reference while it is rendered.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/film/picture.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// All such files begin with this.
inline constexpr std::string_view curve_beginning = "samples,seconds,relmse,mse\n";

/// Compares a picture with its reference again and again, and writes a line for each time: samples per pixel (on
/// average), seconds since the run began, relMSE and MSE as `lightnet compare` has them.
class ErrorCurve {
public:
    /// For pictures of that size. `csv`: file; "": none. Throws UserError where the reference can't be read or is of
    /// another size, or where files of others are in the way.
    ErrorCurve(const std::string& reference, const std::string& csv, std::uint32_t width, std::uint32_t height);

    /// Writes the file anew, with one line more. Throws Error when the disk refuses.
    void note(double samples, double seconds, const Picture& picture);
    /// Of what was noted last; none: nothing was.
    const std::optional<ErrorReport>& last() const { return last_; }

private:
    std::string name_, csv_;
    Picture reference_;
    std::string lines_{curve_beginning};
    std::optional<ErrorReport> last_;
};

}  // namespace lightnet
