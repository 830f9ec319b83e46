#include "core/network/light/inputs.hpp"

#include <cassert>
#include <utility>

namespace lightnet {
namespace {

// Takes care that no ask outlives the buffers that it writes to, whichever way its scope is left.
class Asking {
public:
    Asking(const Input& input, std::span<const Query> questions, std::span<Rgb> answers)
        : port_(*input.port), ticket_(port_.begin(questions, answers)) {}
    Asking(Asking&& other) noexcept : port_(other.port_), ticket_(std::exchange(other.ticket_, 0)) {}
    Asking& operator=(Asking&&) = delete;
    ~Asking() {
        if (ticket_) port_.abandon(ticket_);
    }
    void finish() {
        if (const auto ticket = std::exchange(ticket_, 0)) port_.finish(ticket);
    }

private:
    Port& port_;
    Port::Ticket ticket_;
};

Part empty_part(const Inputs& inputs, std::size_t index, std::size_t questions) {
    Part part{&inputs[index], index, inputs.layers(), {}};
    part.answers.resize(questions * part.input->width());
    return part;
}

}  // namespace

Inputs Inputs::which(bool facts) const {
    std::vector<Input> some;
    for (const auto& input : inputs_)
        if (input.facts == facts) some.push_back(input);
    return {std::move(some), layers_, halved_};
}

Addition Inputs::addition() const {
    std::vector<IdColours> ids;
    for (const auto& input : inputs_)
        if (input.ids) ids.push_back({input.layers.front(), input.ids});
    return {layers_, std::move(ids)};
}

std::vector<Part> ask_all(const Inputs& inputs, std::span<const Query> questions) {
    std::vector<Part> parts;
    parts.reserve(inputs.size());
    std::vector<Asking> asked;
    asked.reserve(inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (!inputs[i].port) continue;
        auto& part = parts.emplace_back(empty_part(inputs, i, questions.size()));
        asked.emplace_back(*part.input, questions, part.answers);
    }
    for (auto& one : asked) one.finish();
    return parts;
}

Part ask(const Inputs& inputs, std::size_t index, std::span<const Query> questions) {
    Part part = empty_part(inputs, index, questions.size());
    if (part.input->port) Asking(*part.input, questions, part.answers).finish();
    return part;
}

Rgb ask_one(const Input& input, const Query& question) {
    assert(input.width() == 1 && "an input with layers is asked with room for all of them");
    Rgb answer;
    if (!input.port) return answer;
    if (const auto ticket = input.port->begin({&question, 1}, {&answer, 1})) input.port->finish(ticket);
    return answer;
}

}  // namespace lightnet
