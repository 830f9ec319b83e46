#include "core/error.hpp"

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
    if (file.empty()) return problem.what;
    return line ? file + ":" + std::to_string(line) + ": " + problem.what : file + ": " + problem.what;
}

UserError::UserError(std::vector<Problem> problems)
    : std::runtime_error(lines(problems)), problems_(std::move(problems)) {}

}  // namespace lightnet
