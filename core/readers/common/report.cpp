#include "core/readers/common/report.hpp"

#include <fmt/format.h>

#include <utility>

namespace lightnet {

void Report::error(const SourceLine& where, std::string what) {
    if (full()) return;
    errors_.push_back({where, std::move(what)});
    if (full()) errors_.push_back({{where.file, 0}, "too many errors, reading ends here"});
}

void Report::warn(const SourceLine& where, const std::string& what) {
    if (const auto known = index_.find(what); known != index_.end()) {
        ++warnings_[known->second].times;
    } else if (warnings_.size() < most_warnings) {
        index_.emplace(what, warnings_.size());
        warnings_.push_back({where, what});
    } else {
        ++left_out_;
    }
}

void Report::check() const {
    if (!good()) throw UserError(errors_);
}

std::vector<Problem> Report::warnings() const {
    std::vector<Problem> result;
    for (const auto& [where, what, times] : warnings_)
        result.push_back({where, times == 1 ? what : fmt::format("{} ({} times)", what, times)});
    if (left_out_) result.push_back({{}, fmt::format("{} more warnings", left_out_)});
    return result;
}

}  // namespace lightnet
