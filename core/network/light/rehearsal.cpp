#include "core/network/light/rehearsal.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

namespace lightnet {
namespace {

// By bits, so that there is an order for whatever numbers come.
auto rank_of(const Query& q) {
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    return std::tuple(q.stream, q.sample, q.instance, q.geometry, q.primitive, bits(q.u), bits(q.v), bits(q.outgoing.x),
                      bits(q.outgoing.y), bits(q.outgoing.z), q.lobes, q.depth, q.time, q.medium);
}

}  // namespace

void sort_and_unite(std::vector<Query>& questions) {
    std::sort(questions.begin(), questions.end(),
              [](const Query& a, const Query& b) { return rank_of(a) < rank_of(b); });
    const auto last = std::unique(questions.begin(), questions.end(),
                                  [](const Query& a, const Query& b) { return rank_of(a) == rank_of(b); });
    questions.erase(last, questions.end());
}

const std::vector<Query>& Rehearsal::noted() {
    sort_and_unite(noted_);
    return noted_;
}

std::vector<Query> Rehearsal::end() {
    on_ = false;
    sort_and_unite(noted_);
    return std::exchange(noted_, {});
}

}  // namespace lightnet
