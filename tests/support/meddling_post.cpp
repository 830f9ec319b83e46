#include "tests/support/meddling_post.hpp"

#include <chrono>
#include <cstring>
#include <list>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <vector>
#include <zmq.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "transport/wire/packet.hpp"

namespace lightnet::test {
namespace {

using Clock = std::chrono::steady_clock;
using Frames = std::vector<std::string>;

Frames receive(zmq::socket_t& socket) {
    Frames frames;
    zmq::message_t frame;
    do {
        if (!socket.recv(frame, zmq::recv_flags::dontwait)) return frames;
        frames.push_back(frame.to_string());
    } while (frame.more());
    return frames;
}

void send(zmq::socket_t& socket, std::span<const std::string> frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto more = i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
        socket.send(zmq::const_buffer(frames[i].data(), frames[i].size()), more | zmq::send_flags::dontwait);
    }
}

bool is_reply(const Frames& frames) {
    for (const auto& frame : frames) {
        const auto header = packet::peek_header(std::as_bytes(std::span(frame)));
        if (header) return packet::is_reply(header->type);
    }
    return false;
}

// True: it was a piece of a result. Those that are cut into parts stay as they are.
bool change_piece(Frames& frames) {
    if (frames.size() < 2) return false;
    auto &header = frames[frames.size() - 2], &body = frames.back();
    const auto told = packet::peek_header(std::as_bytes(std::span(header)));
    if (!told || told->type != packet::Type::blob) return false;
    const auto piece = packet::unpack_piece(std::as_bytes(std::span(body)));
    if (!piece || piece->bytes.empty()) return false;
    const auto* const first = reinterpret_cast<const char*>(piece->bytes.data());
    body[static_cast<std::size_t>(first - body.data())] ^= 1;
    constexpr std::size_t checksum_at = packet::header_size - sizeof(std::uint64_t);
    const std::uint64_t sum = XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(header.data(), checksum_at));
    std::memcpy(header.data() + checksum_at, &sum, sizeof sum);
    return true;
}

}  // namespace

struct MeddlingPost::Desk {
    struct Late {
        Clock::time_point due;
        Frames frames;  // with the route in front
    };
    Desk(std::string to, const Habits& given) : daemon(std::move(to)), habits(given), random(given.seed) {}

    zmq::socket_t& line_of(const std::string& route) {
        auto& line = lines[route];
        if (!line) {
            line = std::make_unique<zmq::socket_t>(context, zmq::socket_type::dealer);
            line->set(zmq::sockopt::linger, 0);
            line->connect(daemon);
        }
        return *line;
    }
    // True: it is kept back.
    bool keep_back(const Frames& frames, Clock::time_point now) {
        if (habits.lies || now < next || !is_reply(frames)) return false;
        next = now + habits.period;
        for (int i = 0; i < 2; ++i)
            late.push_back(
                {now + std::chrono::milliseconds(random() % static_cast<unsigned>(habits.longest.count())), frames});
        return true;
    }
    void deliver_late(Clock::time_point now) {
        std::erase_if(late, [&](const Late& one) {
            if (one.due > now) return false;
            send(door, one.frames);
            return true;
        });
    }

    const std::string daemon;
    const Habits habits;
    std::mt19937 random;
    Clock::time_point next{};
    zmq::context_t context{1};
    zmq::socket_t door{context, zmq::socket_type::router};
    std::map<std::string, std::unique_ptr<zmq::socket_t>> lines;  // to the daemon, one for each that calls
    std::list<Late> late;
};

MeddlingPost::MeddlingPost(const std::string& daemon, const Habits& habits) {
    auto desk = std::make_shared<Desk>(daemon, habits);
    desk->door.set(zmq::sockopt::linger, 0);
    desk->door.bind("tcp://127.0.0.1:*");
    endpoint_ = desk->door.get(zmq::sockopt::last_endpoint);
    thread_ = std::jthread([this, desk](const std::stop_token& stop) { serve(stop, *desk); });
}

MeddlingPost::~MeddlingPost() {
    thread_.request_stop();
    thread_.join();
}

void MeddlingPost::serve(const std::stop_token& stop, Desk& desk) {
    while (!stop.stop_requested()) {
        std::vector<zmq::pollitem_t> items{{desk.door.handle(), 0, ZMQ_POLLIN, 0}};
        for (const auto& [route, line] : desk.lines) items.push_back({line->handle(), 0, ZMQ_POLLIN, 0});
        zmq::poll(items, std::chrono::milliseconds(5));
        for (auto frames = receive(desk.door); !frames.empty(); frames = receive(desk.door))
            send(desk.line_of(frames[0]), std::span(frames).subspan(1));
        const auto now = Clock::now();
        for (const auto& [route, line] : desk.lines) {
            for (auto frames = receive(*line); !frames.empty(); frames = receive(*line)) {
                if (desk.habits.lies && change_piece(frames)) ++meddled_;
                frames.insert(frames.begin(), route);
                if (desk.keep_back(frames, now))
                    ++meddled_;
                else
                    send(desk.door, frames);
            }
        }
        desk.deliver_late(now);
    }
}

}  // namespace lightnet::test
