// Answers of a place to what it is asked.
#include <algorithm>
#include <chrono>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "core/network/light/describe_question.hpp"
#include "core/run/place/full_bundle.hpp"
#include "core/run/place/place.hpp"

namespace lightnet {

// The first that waits, and small bundles behind it, from whomever, that make no more than a full one with it: a node
// that is called once for all has fewer, larger bundles to send itself, and answers don't depend on neighbours.
std::vector<Message> Place::next_asks(std::size_t node) {
    auto& waiting = inboxes_[node].waiting;
    std::vector<Message> asks;
    std::size_t questions = 0;
    const std::size_t most = full_bundle(tuning_.bundle, 1e-9 * inboxes_[node].question_ns);
    const auto fits = [&](const Message& ask) {
        return asks.empty() || (std::holds_alternative<Questions<Query>>(ask.questions) &&
                                std::holds_alternative<Questions<Query>>(asks.front().questions) &&
                                ask.width == asks.front().width && questions + work_in(ask) <= most);
    };
    while (!waiting.empty() && fits(waiting.front())) {
        questions += work_in(waiting.front());
        asks.push_back(std::move(waiting.front()));
        waiting.pop_front();
    }
    counters_.merged += asks.size() - 1;
    return asks;
}

bool Place::is_learning(const Message& ask) {
    const auto* tiles = std::get_if<Questions<Tile>>(&ask.questions);
    return std::holds_alternative<Questions<Step>>(ask.questions) || (tiles && (*tiles)->front().rehearses());
}

// What it tells of work of this kind, for those who plan later runs.
void Place::note_cost(NodeRecord& figures, const Message& ask, std::uint64_t ns, std::size_t questions) {
    if (is_learning(ask))
        figures.shard_ns += ns;
    else
        figures.costs.add(static_cast<double>(ns) / static_cast<double>(questions), questions);
}

void Place::answer(std::vector<Message>& asks) {
    auto& inbox = inboxes_[asks.front().node];
    gauge_.set_activity(Gauge::at(asks.front().node));
    const bool spare = inbox.fibers++ > 0;
    spare_in_use_ += spare;
    std::size_t questions = 0;
    for (const auto& ask : asks) questions += work_in(ask);
    inbox.answering += questions;
    const auto* fiber = fibers_.current();
    std::vector<Message> replies;
    std::vector<AsksInHand::Name> names;
    for (auto& ask : asks) replies.push_back(reply_to(ask)), names.push_back(AsksInHand::name_of(ask));
    if (is_learning(asks.front())) learning_[fiber] = asks.front().node;
    if (asks.size() == 1 || !answer_together(asks, replies))
        for (std::size_t i = 0; i < asks.size(); ++i) answer_alone(asks[i], replies[i]);

    learning_.erase(fiber);
    const auto ran = fibers_.running_time(fiber);
    inbox.figures.answered += questions;
    inbox.figures.busy_ns += static_cast<std::uint64_t>(ran.count());
    const bool shards = std::holds_alternative<Questions<Step>>(asks.front().questions);
    double& each_ns = shards ? inbox.shard_ns : inbox.question_ns;
    const double ns = static_cast<double>(ran.count()) / static_cast<double>(questions);
    note_cost(inbox.figures, asks.front(), static_cast<std::uint64_t>(ran.count()), questions);
    each_ns = each_ns > 0 ? 0.8 * each_ns + 0.2 * ns : ns;
    inbox.questions -= questions;
    inbox.answering -= questions;
    gauge_.nodes[asks.front().node].waiting.set(inbox.questions);
    --inbox.fibers;
    spare_in_use_ -= spare;
    const auto node = asks.front().node;
    asks.clear();  // before the replies: an asker may use the memory of its questions again
    const Load load = load_of(node, each_ns);
    for (std::size_t i = 0; i < replies.size(); ++i) {
        auto& reply = replies[i];
        reply.load = load;
        reply.route = in_hand_.let_go(names[i]);
        gauge_.pulse.add(1);
        progress_->fetch_add(1, std::memory_order_relaxed);  // before: the run may end with this reply
        carrier_.reply(std::move(reply));
    }
}

// Calls the node once for several bundles. False: it threw, and nobody has an answer.
bool Place::answer_together(const std::vector<Message>& asks, std::vector<Message>& replies) {
    std::vector<Query> questions;
    for (const auto& ask : asks) {
        const auto& more = *std::get<Questions<Query>>(ask.questions);
        questions.insert(questions.end(), more.begin(), more.end());
    }
    try {
        const auto answers = light_answers(asks.front().node, asks.front().width, questions);
        auto from = answers.begin();
        for (std::size_t i = 0; i < asks.size(); ++i) {
            const auto next = from + static_cast<std::ptrdiff_t>(work_in(asks[i]) * asks[i].width);
            replies[i].answers.assign(from, next);
            from = next;
        }
        return true;
    } catch (const std::exception&) {  // each alone will tell whose question it was
        return false;
    }
}

void Place::answer_alone(const Message& ask, Message& reply) {
    const Tile* at = nullptr;  // none: what a light operator threw has its name already
    const auto text_of = [&](const std::exception& error) {
        const auto who = at ? "'" + network_.graph.nodes[ask.node].name + "' at " + describe(*at) + ", " : "";
        return who + "on " + my_name() + ": " + words_of(error);
    };
    try {
        if (const auto* steps = std::get_if<Questions<Step>>(&ask.questions)) {
            reply.data = preparer_.shards(ask.node, (*steps)->front());
        } else if (std::holds_alternative<Questions<Tile>>(ask.questions)) {
            reply.answers = pixel_answers(ask, at);
        } else {
            reply.answers = light_answers(ask.node, ask.width, *std::get<Questions<Query>>(ask.questions));
        }
    } catch (const NodeError& error) {
        reply.type = Message::Type::failure;
        reply.trouble = {text_of(error), error.host().empty() ? me_.host : error.host()};
    } catch (const std::exception& error) {
        reply.type = Message::Type::failure;
        reply.trouble = {text_of(error), me_.host};
    }
}

std::vector<Rgb> Place::light_answers(std::size_t node, std::size_t width, std::span<const Query> questions) {
    if (network_.kind_of(node).role != Role::light || !network_.answers_with(node, width))
        throw Error("was asked for light in a way that its graph does not have");
    std::vector<Rgb> answers(questions.size() * width);
    lightnet::answer(assembly_.callee(node), width, questions, answers);
    return answers;
}

// `at`: the tile that is being rendered.
std::vector<Rgb> Place::pixel_answers(const Message& message, const Tile*& at) {
    const auto& tiles = *std::get<Questions<Tile>>(message.questions);
    const std::size_t layers = network_.width_of(message.node);
    if (network_.kind_of(message.node).role != Role::image || message.width != layers)
        throw Error("was asked for pixels in a way that its graph does not have");
    std::vector<Rgb> pixels(answers_to(tiles, layers)), unseen;
    std::size_t first = 0;
    for (const auto& tile : tiles) {
        at = &tile;
        const std::size_t size = answers_to(tile, layers);
        if (tile.rehearses()) unseen.assign(tile.pixels() * layers, {});
        assembly_.renderer(message.node)
            .render(tile, tile.rehearses() ? std::span(unseen) : std::span(pixels).subspan(first, size));
        first += size;
        ++counters_.tiles;
    }
    return pixels;
}

Load Place::load_of(std::size_t node, double service_ns) const {
    return {static_cast<std::uint32_t>(inboxes_[node].questions),
            static_cast<std::uint32_t>(std::clamp(service_ns, 1.0, 4e9))};
}

}  // namespace lightnet
