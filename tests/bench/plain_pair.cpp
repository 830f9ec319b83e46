#include "tests/bench/plain_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>
#include <zmq.hpp>

#include "tests/bench/figure.hpp"
#include "transport/keys/key.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::bench {

std::vector<Query> some_questions(std::size_t count) {
    std::vector<Query> questions(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        const float angle = 0.1f * static_cast<float>(i);
        questions[i].stream = 0x9e3779b97f4a7c15ull * (i + 1);
        questions[i].geometry = n % 8;
        questions[i].primitive = n % 30;
        questions[i].sample = n % 16;
        questions[i].u = 0.5f / static_cast<float>(i + 1);
        questions[i].v = 0.25f;
        questions[i].outgoing = {std::cos(angle), 0, std::sin(angle)};
    }
    return questions;
}

Rgb answer_to(const Query& question) { return {question.u, question.v, question.outgoing.x}; }

std::atomic<double>& work_of_question() {
    static std::atomic<double> seconds{0};
    return seconds;
}

void work_on(std::size_t questions) {
    const double seconds = work_of_question().load(std::memory_order_relaxed) * static_cast<double>(questions);
    if (seconds <= 0) return;
    const double end = thread_seconds() + seconds;
    while (thread_seconds() < end) {
    }
}

void expect_answers(std::span<const Query> questions, std::span<const Rgb> answers) {
    for (std::size_t i = 0; i < questions.size(); ++i)
        if (answers[i] != answer_to(questions[i])) throw std::runtime_error("a wrong answer came back");
}

namespace {

std::vector<Rgb> answers_to_all(std::span<const Query> questions) {
    std::vector<Rgb> answers;
    for (const Query& question : questions) answers.push_back(answer_to(question));
    return answers;
}

struct Packets {
    std::vector<std::byte> ask, reply;
};

std::vector<std::byte> bytes_of(const Message& message) {
    auto [bytes, body] = packet::pack(message, 0);
    bytes.insert(bytes.end(), body.begin(), body.end());
    return bytes;
}

Packets packets_of(std::size_t count) {
    const auto questions = some_questions(count);
    Message ask;
    ask.questions = std::make_shared<const std::vector<Query>>(questions);
    Message reply = reply_to(ask);
    reply.answers = answers_to_all(questions);
    return {bytes_of(ask), bytes_of(reply)};
}

}  // namespace

PacketSizes packet_sizes(std::size_t questions) {
    const Packets packets = packets_of(questions);
    return {packets.ask.size(), packets.reply.size()};
}

namespace {

/// `question` and `take` are called by the asking thread, `answer` by the other one.
class Carried {
public:
    virtual ~Carried() = default;
    virtual zmq::message_t question() = 0;
    virtual zmq::message_t answer(const zmq::message_t& question) = 0;
    virtual void take(const zmq::message_t& answer) = 0;
    /// Throws when what was taken last is wrong.
    virtual void check() const = 0;
};

class PlainPackets final : public Carried {
public:
    explicit PlainPackets(std::size_t count) : packets_(packets_of(count)) {
        there_.resize(packets_.ask.size());
        back_.resize(packets_.reply.size());
    }
    zmq::message_t question() override { return {packets_.ask.data(), packets_.ask.size()}; }
    zmq::message_t answer(const zmq::message_t& question) override {
        std::memcpy(there_.data(), question.data(), question.size());
        return {packets_.reply.data(), packets_.reply.size()};
    }
    void take(const zmq::message_t& answer) override { std::memcpy(back_.data(), answer.data(), answer.size()); }
    void check() const override {
        if (there_ != packets_.ask || back_ != packets_.reply) throw std::runtime_error("other bytes arrived");
    }

private:
    Packets packets_;
    std::vector<std::byte> there_, back_;
};

class PlainCopies final : public Carried {
public:
    explicit PlainCopies(std::size_t count) : questions_(some_questions(count)), there_(count), answers_(count) {}
    zmq::message_t question() override { return {questions_.data(), questions_.size() * sizeof(Query)}; }
    zmq::message_t answer(const zmq::message_t& question) override {
        std::memcpy(there_.data(), question.data(), question.size());
        zmq::message_t reply(there_.size() * sizeof(Rgb));
        for (std::size_t i = 0; i < there_.size(); ++i) {
            const Rgb one = answer_to(there_[i]);
            std::memcpy(static_cast<std::byte*>(reply.data()) + i * sizeof one, &one, sizeof one);
        }
        return reply;
    }
    void take(const zmq::message_t& answer) override { std::memcpy(answers_.data(), answer.data(), answer.size()); }
    void check() const override { expect_answers(questions_, answers_); }

private:
    std::vector<Query> questions_, there_;
    std::vector<Rgb> answers_;
};

/// The questions stay where they are; each reply is made anew, and freed by the asker.
class PlainPointers final : public Carried {
public:
    explicit PlainPointers(std::size_t count) : questions_(some_questions(count)), answers_(count) {}
    zmq::message_t question() override { return pointer_to(&questions_); }
    zmq::message_t answer(const zmq::message_t& question) override {
        const auto& asked = *read<const std::vector<Query>>(question);
        auto replies = std::make_unique<std::vector<Rgb>>(asked.size());
        for (std::size_t i = 0; i < asked.size(); ++i) (*replies)[i] = answer_to(asked[i]);
        return pointer_to(replies.release());
    }
    void take(const zmq::message_t& answer) override {
        const std::unique_ptr<std::vector<Rgb>> replies(read<std::vector<Rgb>>(answer));
        std::copy(replies->begin(), replies->end(), answers_.begin());
    }
    void check() const override { expect_answers(questions_, answers_); }

private:
    static zmq::message_t pointer_to(const void* what) { return {&what, sizeof what}; }
    template <class T>
    static T* read(const zmq::message_t& message) {
        T* what = nullptr;
        std::memcpy(&what, message.data(), sizeof what);
        return what;
    }
    std::vector<Query> questions_;
    std::vector<Rgb> answers_;
};

void set_up(zmq::socket_t& socket) {
    socket.set(zmq::sockopt::sndhwm, 0);
    socket.set(zmq::sockopt::rcvhwm, 0);
    socket.set(zmq::sockopt::linger, 0);
}

void exchange_keys(zmq::socket_t& router, zmq::socket_t& dealer) {
    const auto text = [](const auto& bytes) { return std::string(bytes.begin(), bytes.end()); };
    const auto one = KeyPair::random(), other = KeyPair::random();
    router.set(zmq::sockopt::curve_server, true);
    router.set(zmq::sockopt::curve_secretkey, text(one.secret));
    dealer.set(zmq::sockopt::curve_serverkey, text(one.open.bytes));
    dealer.set(zmq::sockopt::curve_publickey, text(other.open.bytes));
    dealer.set(zmq::sockopt::curve_secretkey, text(other.secret));
}

// Until an empty message comes.
void answer_plainly(zmq::socket_t& router, Carried& load, std::size_t questions) {
    while (true) {
        zmq::message_t route, message;
        (void)router.recv(route);
        (void)router.recv(message);
        if (message.size() == 0) return;
        work_on(questions);
        router.send(route, zmq::send_flags::sndmore);
        router.send(load.answer(message), zmq::send_flags::none);
    }
}

std::unique_ptr<Carried> carried(PlainLoad load, std::size_t questions) {
    switch (load) {
        case PlainLoad::packets:
            return std::make_unique<PlainPackets>(questions);
        case PlainLoad::copies:
            return std::make_unique<PlainCopies>(questions);
        default:
            return std::make_unique<PlainPointers>(questions);
    }
}

}  // namespace

struct PlainPair::Sockets {
    // Over tcp each end has a context, and so a thread of ZeroMQ's own, as in two processes; inproc knows only one.
    zmq::context_t context{1}, other{1};
    zmq::socket_t router{context, zmq::socket_type::router}, dealer;
    std::unique_ptr<Carried> load;
    std::jthread answerer;

    Sockets(bool within_process, std::unique_ptr<Carried> carries)
        : dealer(within_process ? context : other, zmq::socket_type::dealer), load(std::move(carries)) {}
};

PlainPair::PlainPair(const std::string& endpoint, PlainLoad load, std::size_t questions, PlainLine line)
    : sockets_(std::make_unique<Sockets>(endpoint.starts_with("inproc"), carried(load, questions))) {
    Sockets& all = *sockets_;
    set_up(all.router);
    set_up(all.dealer);
    if (line == PlainLine::with_keys) exchange_keys(all.router, all.dealer);
    all.router.bind(endpoint);
    all.dealer.connect(all.router.get(zmq::sockopt::last_endpoint));
    all.answerer = std::jthread([&all, questions] { answer_plainly(all.router, *all.load, questions); });
}

PlainPair::~PlainPair() { sockets_->dealer.send(zmq::message_t(), zmq::send_flags::none); }

double PlainPair::seconds_of(std::size_t asks, std::size_t in_flight) {
    zmq::socket_t& dealer = sockets_->dealer;
    Carried& load = *sockets_->load;
    const auto send = [&] { dealer.send(load.question(), zmq::send_flags::none); };
    const double seconds = bench::seconds_of([&] {
        for (std::size_t i = 0; i < in_flight; ++i) send();
        for (std::size_t i = 0; i < asks; ++i) {
            zmq::message_t message;
            (void)dealer.recv(message);
            load.take(message);
            if (i + in_flight < asks) send();
        }
    });
    load.check();
    return seconds;
}

}  // namespace lightnet::bench
