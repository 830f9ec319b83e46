#include "core/scene/path_kinds.hpp"

#include <utility>

namespace lightnet {
namespace {

thread_local PathKindWatch* watching = nullptr;

}  // namespace

std::string_view word_of(PathKind kind) {
    constexpr std::array<std::string_view, path_kinds> words{"LD", "LD+D", "LGD", "LD+G", "LS+D", "LD+S+D"};
    return words[static_cast<std::size_t>(kind)];
}

PathKindWatch::PathKindWatch() : before_(std::exchange(watching, this)) {}
PathKindWatch::~PathKindWatch() { watching = before_; }
PathKindWatch* PathKindWatch::here() { return watching; }

LightByKind PathKindWatch::take() { return std::exchange(found_, {}); }

void PathKindWatch::tell(std::span<const Rgb> sums, std::size_t groups, std::span<Rgb> answers) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::size_t question = i / (groups * told::states), state = i / groups % told::states;
        answers[question * groups + i % groups] += sums[i];
        found_[static_cast<std::size_t>(told::kind_of(std::uint32_t(state)))] += double{luminance(sums[i])};
    }
}

}  // namespace lightnet
