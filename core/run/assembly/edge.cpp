#include "core/run/assembly/edge.hpp"

#include "core/run/assembly/account.hpp"

namespace lightnet {

Edge::Edge(const Ends& ends, Port& port, const Watch& watch)
    : ends_(ends),
      port_(port),
      watch_(watch),
      measured_(watch.meter ? &watch.meter->measured(ends.asker, ends.asked) : nullptr) {}

Port::Ticket Edge::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    if (watch_.locks) watch_.locks->check_may_ask();
    if (!measured_) return ask(questions, answers);
    EdgeMeter::Asking asking(*watch_.meter, *measured_, questions.size());
    const auto ticket = ask(questions, answers);
    asking.begun(ends_.asker, ends_.asked, ticket == 0);
    return ticket;
}

Port::Ticket Edge::ask(std::span<const Query> questions, std::span<Rgb> answers) {
    if (!watch_.keeper || !watch_.keeper->keeps()) return port_.begin(questions, answers);
    for (std::size_t q = 0; q < questions.size(); ++q)
        watch_.keeper->ask(ends_.asker, ends_.asked, port_, questions[q],
                           answers.subspan(q * ends_.width, ends_.width));
    return 0;
}

void Edge::finish(Ticket ticket) {
    const auto begun = std::chrono::steady_clock::now();
    port_.finish(ticket);
    if (measured_)
        measured_->record.waited_ns +=
            static_cast<std::uint64_t>((std::chrono::steady_clock::now() - begun) / std::chrono::nanoseconds(1));
}

}  // namespace lightnet
