// Plain ZeroMQ, for benchmarks of the carrier to be measured beside: a DEALER that asks, a ROUTER that answers.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"

namespace lightnet::bench {

/// Such as a renderer asks about a small scene, and what is answered to each.
std::vector<Query> some_questions(std::size_t count);
Rgb answer_to(const Query& question);
/// Seconds of the processor that whoever answers spends on each question, besides what it costs to carry it: 0 at
/// first. Of all that answer in this process.
std::atomic<double>& work_of_question();
/// Spends them.
void work_on(std::size_t questions);
/// Throws when some answer is another.
void expect_answers(std::span<const Query> questions, std::span<const Rgb> answers);

/// Bytes of the packets in which so many questions and their answers travel.
struct PacketSizes {
    std::size_t ask, reply;
};
PacketSizes packet_sizes(std::size_t questions);

/// What a plain loop carries.
enum class PlainLoad {
    packets,   // bytes as many as our packets have, which nobody looks at
    copies,    // of questions and answers
    pointers,  // to both
};

/// Is what passes encrypted (CURVE)?
enum class PlainLine { open, with_keys };

class PlainPair {
public:
    /// Over inproc or tcp; each message carries so many questions, or their answers.
    PlainPair(const std::string& endpoint, PlainLoad load, std::size_t questions, PlainLine line = PlainLine::open);
    ~PlainPair();
    PlainPair(const PlainPair&) = delete;
    PlainPair& operator=(const PlainPair&) = delete;

    /// Until so many messages are answered, of which so many are under way. Throws when what came back is wrong.
    double seconds_of(std::size_t asks, std::size_t in_flight);

private:
    struct Sockets;
    std::unique_ptr<Sockets> sockets_;
};

}  // namespace lightnet::bench
