#include "core/run/assembly/node_by_pass.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/film/tile.hpp"

namespace lightnet {

void NodeByPass::begin(std::uint32_t pass) const {
    if (now_.light && now_.pass == pass) return;
    before_ = now_.prepared ? std::exchange(now_, {}) : Version{};
    now_ = {make_(pass), pass, false};
}

void NodeByPass::prepare(Services& services) {
    const auto light = now_.light;  // stays until it has returned, whatever begins meanwhile
    light->prepare(services);
    if (now_.light == light) now_.prepared = true;
}

Frozen NodeByPass::frozen() const {
    if (!now_.light) begin(0);
    return now_.light->frozen();
}

std::shared_ptr<const LightOp> NodeByPass::of(std::uint16_t mark) const {
    if (mark == 0)
        throw Error("was asked without a pass: whoever asks must hand on that of the question that it answers itself");
    if (!now_.light) begin(mark - 1u);
    if (mark == mark_of_pass(now_.pass)) return now_.light;
    if (before_.light && mark == mark_of_pass(before_.pass)) return before_.light;
    const auto ahead = (mark + pass_marks - mark_of_pass(now_.pass)) % pass_marks;
    if (ahead > pass_marks / 2) return nullptr;  // behind
    begin(now_.pass + ahead);                    // a rehearsal, before this node prepares
    return now_.light;
}

void NodeByPass::light(std::span<const Query> questions, std::span<Rgb> answers) const {
    const std::size_t width = questions.empty() ? 0 : answers.size() / questions.size();
    for (std::size_t first = 0, last = 0; first < questions.size(); first = last) {
        const auto mark = questions[first].pass;
        for (last = first + 1; last < questions.size() && questions[last].pass == mark;) ++last;
        const auto light = of(mark);  // stays until it has answered
        if (light)
            light->light(questions.subspan(first, last - first),
                         answers.subspan(first * width, (last - first) * width));
    }
}

}  // namespace lightnet
