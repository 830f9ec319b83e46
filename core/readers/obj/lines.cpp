#include "core/readers/obj/lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/readers/files/trimmed.hpp"

namespace lightnet::obj {
namespace {

constexpr std::string_view spaces = " \t\r\v\f";

}  // namespace

std::string_view Lines::cut() {
    const auto end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const auto line = trimmed(text_.substr(at_, end - at_), spaces);
    at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
    ++ended_;
    return line;
}

bool Lines::next() {
    while (at_ < text_.size()) {
        line_ = ended_ + 1;
        left_ = cut();
        if (left_.ends_with('\\')) {
            joined_.clear();
            for (; left_.ends_with('\\') && at_ < text_.size(); left_ = cut())
                joined_.append(left_.substr(0, left_.size() - 1)).push_back(' ');
            left_ = joined_.append(left_);
        }
        if (!left_.empty() && left_.front() != '#') return true;
    }
    return false;
}

std::string_view Lines::word() {
    left_ = trimmed(left_, spaces);
    const auto end = std::min(left_.find_first_of(spaces), left_.size());
    const auto word = left_.substr(0, end);
    left_.remove_prefix(end);
    return word;
}

std::string_view Lines::rest() { return trimmed(std::exchange(left_, {}), spaces); }

std::optional<float> Lines::number(Report& report) {
    auto digits = word();
    if (digits.empty() || digits.front() == '#') return std::nullopt;
    const auto written = digits;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem == std::errc::result_out_of_range && std::fabs(value) < 1)
        value = 0;  // too small to matter
    else if (problem != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(float(value))) {
        report.error(where(), fmt::format("a finite number expected, not '{}'", written.substr(0, 32)));
        return std::nullopt;
    }
    return static_cast<float>(value);
}

}  // namespace lightnet::obj
