// "Did you mean …?" for names that nobody knows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// " (did you mean 'x'?)" where one of `known` is close to `word`, else "". Ties go to the earlier one. Meant to be
/// appended to a message.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace lightnet
