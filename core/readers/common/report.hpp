// Mistakes and approximations of scene files, collected while a reader reads on.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

/// Ends what is said of light that a file lacks; it is said only where nobody has chosen one.
inline constexpr std::string_view choose_around = "(choose one with '--env')";

/// Collects the problems of one read. Equal warnings are said once, where they came up first, with their number.
class Report {
public:
    void error(const SourceLine& where, std::string what);
    void warn(const SourceLine& where, const std::string& what);

    /// True when so much is wrong that reading on would only repeat it.
    bool full() const { return errors_.size() >= most_errors; }
    bool good() const { return errors_.empty(); }
    /// Throws UserError with all errors, if there are any.
    void check() const;
    /// In the order in which they came up.
    std::vector<Problem> warnings() const;

private:
    static constexpr std::size_t most_errors = 100;
    static constexpr std::size_t most_warnings = 1000;  // different ones; the rest only counts

    struct Warning {
        SourceLine where;
        std::string what;
        std::size_t times = 1;
    };
    std::vector<Problem> errors_;
    std::vector<Warning> warnings_;
    std::map<std::string, std::size_t> index_;
    std::size_t left_out_ = 0;
};

}  // namespace lightnet
