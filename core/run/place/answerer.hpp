// The nodes of a place, called for what others ask.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/message/message.hpp"
#include "core/run/place/preparer.hpp"

namespace lightnet {

/// Turns asks into replies. What a node throws becomes the reply of the ask that it was asked by. One place's.
class Answerer {
public:
    /// The place's, which outlive it. `name`: as errors call the place.
    struct Lent {
        const Network& network;
        Assembly& assembly;
        Preparer& preparer;
        std::string host, name;
        std::uint64_t& tiles;  // that were rendered
    };
    explicit Answerer(Lent lent) : at_(std::move(lent)) {}

    /// Asks of one node and kind, each of which has a reply.
    void answer(const std::vector<Message>& asks, std::vector<Message>& replies);

private:
    bool answer_together(const std::vector<Message>& asks, std::vector<Message>& replies);
    void answer_alone(const Message& ask, Message& reply);
    std::vector<Rgb> light_answers(std::size_t node, std::size_t width, std::span<const Query> questions);
    std::vector<Rgb> pixel_answers(const Message& message, const Tile*& at);

    Lent at_;
};

}  // namespace lightnet
