#include "core/run/place/answerer.hpp"

#include <utility>
#include <variant>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "core/network/light/describe_question.hpp"

namespace lightnet {

void Answerer::answer(const std::vector<Message>& asks, std::vector<Message>& replies) {
    if (asks.size() > 1 && answer_together(asks, replies)) return;
    for (std::size_t i = 0; i < asks.size(); ++i) answer_alone(asks[i], replies[i]);
}

// Calls the node once for several bundles. False: it threw, and nobody has an answer.
bool Answerer::answer_together(const std::vector<Message>& asks, std::vector<Message>& replies) {
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

void Answerer::answer_alone(const Message& ask, Message& reply) {
    const Tile* at = nullptr;  // none: what a light operator threw has its name already
    const auto text_of = [&](const std::exception& error) {
        const auto who = at ? "'" + at_.network.graph.nodes[ask.node].name + "' at " + describe(*at) + ", " : "";
        return who + "on " + at_.name + ": " + words_of(error);
    };
    try {
        if (const auto* steps = std::get_if<Questions<Step>>(&ask.questions)) {
            reply.data = at_.preparer.shards(ask.node, (*steps)->front());
        } else if (std::holds_alternative<Questions<Tile>>(ask.questions)) {
            reply.answers = pixel_answers(ask, at);
        } else {
            reply.answers = light_answers(ask.node, ask.width, *std::get<Questions<Query>>(ask.questions));
        }
    } catch (const NodeError& error) {
        reply.type = Message::Type::failure;
        reply.trouble = {text_of(error), error.host().empty() ? at_.host : error.host()};
    } catch (const std::exception& error) {
        reply.type = Message::Type::failure;
        reply.trouble = {text_of(error), at_.host};
    }
}

std::vector<Rgb> Answerer::light_answers(std::size_t node, std::size_t width, std::span<const Query> questions) {
    if (at_.network.kind_of(node).role != Role::light || !at_.network.answers_with(node, width))
        throw Error("was asked for light in a way that its graph does not have");
    std::vector<Rgb> answers(questions.size() * width);
    lightnet::answer(at_.assembly.callee(node), width, questions, answers);
    return answers;
}

// `at`: the tile that is being rendered.
std::vector<Rgb> Answerer::pixel_answers(const Message& message, const Tile*& at) {
    const auto& tiles = *std::get<Questions<Tile>>(message.questions);
    const std::size_t layers = at_.network.width_of(message.node);
    if (at_.network.kind_of(message.node).role != Role::image || message.width != layers)
        throw Error("was asked for pixels in a way that its graph does not have");
    std::vector<Rgb> pixels(answers_to(tiles, layers)), unseen;
    std::size_t first = 0;
    for (const auto& tile : tiles) {
        at = &tile;
        const std::size_t size = answers_to(tile, layers);
        if (tile.rehearses()) unseen.assign(tile.pixels() * layers, {});
        at_.assembly.renderer(message.node)
            .render(tile, tile.rehearses() ? std::span(unseen) : std::span(pixels).subspan(first, size));
        first += size;
        ++at_.tiles;
    }
    return pixels;
}

}  // namespace lightnet
