#include "core/base/error.hpp"

#include "core/base/printable.hpp"

namespace lightnet {
namespace {

std::string lines(const std::vector<Problem>& problems) {
    std::string text;
    for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + to_string(problem);
    return text;
}

}  // namespace

std::string to_string(const Problem& problem) {
    const auto& [file, line] = problem.where;
    const std::string what = printable(problem.what, true);
    if (file.empty()) return what;
    return printable(file) + (line ? ":" + std::to_string(line) : "") + ": " + what;
}

UserError::UserError(std::vector<Problem> problems)
    : std::runtime_error(lines(problems)), problems_(std::move(problems)) {}

Error::Error(const std::string& what) : std::runtime_error(printable(what, true)) {}

}  // namespace lightnet
