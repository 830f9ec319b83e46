// Messages between places, before a carrier turns them into bytes or hands them over as they are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/film/tile.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/message/step.hpp"

namespace lightnet {

/// How busy an answerer is; rides on every reply.
struct Load {
    std::uint32_t fill = 0;        // questions that wait there
    std::uint32_t service_ns = 0;  // measured time per question; 0: not known yet
    friend bool operator==(const Load&, const Load&) = default;
};

/// The questions of one bundle. Shared and constant: the asker keeps them until the reply is there.
template <class Question>
using Questions = std::shared_ptr<const std::vector<Question>>;

/// What answers a bundle of questions: colours, those of each question side by side; of shards, join_shards() of
/// theirs.
template <class Question>
using Answers = std::conditional_t<std::is_same_v<Question, Step>, Bytes, std::vector<Rgb>>;

/// Why there is no answer.
struct Failure {
    std::string why;
    std::string host;  // where it happened, which may be further up than who was asked
    bool lie = false;  // it has answered otherwise than others did; "" as the host: somebody has, and who is not known
    friend bool operator==(const Failure&, const Failure&) = default;
};

/// How a reply finds its way back; only carriers look inside.
struct Route {
    std::vector<std::string> hops;
};

/// What is said. A question wears several numbers on its way, each given by who must know it again:
///
///   ticket   Port          one ask of a node; who asked finishes it by its ticket
///   number   BundleOwner   one bundle, in which questions of several asks may go; the owner finds its asks again by it
///   work     Multiplexer   one bundle that is wanted, or a piece of one that was cut up; it may be sent several times
///   copy     Scheduler     one sending of it, which takes credit at one replica
///   channel  asking place  one node at one other place
///
/// To a channel, a copy is a bundle like any other: Message::bundle is the number of the copy where a multiplexer asks.
/// Bundles are filled by BundlePort (questions of several asks) and MasterRenderer (several quick tiles), cut by
/// Multiplexer (among idle replicas) and SectorPort (by sector), and several of them are answered together by Place.
struct Message {
    enum class Type : std::uint8_t {
        ask,      // questions for `node`
        reply,    // answers to them
        failure,  // there will be none: see `trouble`
        plan,     // who answers for which node from now on
        stop,     // end the run: to a place
    };

    Type type = Type::ask;
    std::uint64_t run = 0;      // messages of other runs are dropped
    std::uint32_t channel = 0;  // the asker's; comes back with the reply
    std::uint64_t bundle = 0;   // its number, unique per channel; comes back with the reply
    std::uint32_t node = 0;     // index in the graph
    std::uint32_t width = 1;    // colours per question that are wanted; 0: nobody waits for the reply
    std::uint64_t asker = 0;    // of an ask: name_of() the asking place; 0: the launcher
    std::uint32_t edition = 0;  // of an ask: of the plan in force that the asker goes by; see AsksOfLaterPlans
    std::variant<std::monostate, Questions<Query>, Questions<Tile>, Questions<Step>> questions;
    std::vector<Rgb> answers;
    Bytes data;  // what a step is about, or its answer
    Load load;
    Failure trouble;
    std::shared_ptr<const Plan> plan;
    Route route;  // of an ask that has arrived
};

/// The beginnings of a reply: the same names, and the way back.
inline Message reply_to(Message& ask) {
    Message reply;
    reply.type = Message::Type::reply;
    reply.run = ask.run, reply.channel = ask.channel, reply.bundle = ask.bundle, reply.node = ask.node;
    reply.width = ask.width;
    reply.route = std::move(ask.route);
    return reply;
}

/// The answers of a reply to such questions. Leaves none there.
template <class Question>
Answers<Question> take_answers(Message& reply) {
    if constexpr (std::is_same_v<Question, Step>)
        return std::move(reply.data);
    else
        return std::move(reply.answers);
}

/// How much work questions are: tiles count their blocks of samples.
template <class Question>
std::size_t work_in(const std::vector<Question>& questions) {
    if constexpr (std::is_same_v<Question, Tile>) {
        std::size_t blocks = 0;
        for (const auto& tile : questions) blocks += tile.blocks();
        return blocks;
    }
    return questions.size();
}

/// How much work the questions of a message are.
inline std::size_t work_in(const Message& message) {
    return std::visit(
        [](const auto& questions) -> std::size_t {
            if constexpr (std::is_same_v<std::decay_t<decltype(questions)>, std::monostate>)
                return 0;
            else
                return work_in(*questions);
        },
        message.questions);
}

/// How many colours answer one question when each has `width`.
inline std::size_t answers_to(const Query&, std::size_t width) { return width; }
inline std::size_t answers_to(const Tile& tile, std::size_t width) {
    return tile.rehearses() ? 0 : tile.told() * width;
}

inline std::size_t answers_to(const Step&, std::size_t) { return 0; }  // but bytes

template <class Question>
std::size_t answers_to(const std::vector<Question>& questions, std::size_t width) {
    std::size_t sum = 0;
    for (const auto& question : questions) sum += answers_to(question, width);
    return sum;
}

}  // namespace lightnet
