#include "core/base/problem_list.hpp"

#include <utility>

namespace lightnet {

std::string shortened(std::string text, std::size_t most) {
    if (text.size() <= most) return text;
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    std::size_t end = most;
    while (end > 0 && continues(text[end])) --end;
    text.resize(end);
    return text + "…";
}

void ProblemList::add(SourceLine where, std::string what) {
    if (told_.size() >= most)
        ++untold_;
    else
        told_.push_back({std::move(where), shortened(std::move(what), longest)});
}

std::vector<Problem> ProblemList::take() {
    if (untold_ > 0) told_.push_back({{}, "and " + std::to_string(untold_) + " more"});
    untold_ = 0;
    return std::exchange(told_, {});
}

}  // namespace lightnet
