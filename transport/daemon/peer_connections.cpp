#include "transport/daemon/peer_lines.hpp"

#include <algorithm>
#include <utility>
#include <zmq.hpp>

#include "transport/wire/relay_address.hpp"

namespace lightnet {
namespace {

constexpr auto unreachable_after = std::chrono::seconds(1);  // then the launcher passes on what is for that host
constexpr auto look_interval = std::chrono::milliseconds(200);

}  // namespace

HostLines::HostLines(zmq::context_t& context, std::string me, Takers takers)
    : context_(context), me_(std::move(me)), takers_(std::move(takers)) {}

HostLines::~HostLines() = default;

HostLines::Line& HostLines::line_to(const std::string& host) {
    const auto [found, fresh] = lines_.try_emplace(host);
    auto& line = found->second;
    if (!fresh) return line;
    try {
        if (calls_directly(me_, host)) line.socket = std::make_unique<zmq::socket_t>(asking_socket(context_, host));
    } catch (const zmq::error_t&) {  // out of descriptors, say: the launcher has a line already
    }
    line.relayed = !line.socket;
    return line;
}

bool HostLines::send(Line& line, Frames& frames) {
    Frames packet;
    packet.push_back(frame_of(seal({me_, text_of(frames[0])})));
    for (const auto i : {2u, 3u}) packet.emplace_back().copy(frames[i]);
    return send_frames(*line.socket, packet);
}

void HostLines::ask(Frames frames) {
    auto& line = line_to(text_of(frames[1]));
    if (line.relayed) return takers_.launcher(frames);
    if (!line.waiting.empty() || !send(line, frames)) line.waiting.push_back(std::move(frames));
}

void HostLines::tick(Time now) {
    const bool look = now - looked_ >= look_interval;
    if (look) looked_ = now;
    for (auto& [host, line] : lines_) {
        if (!line.socket) continue;
        while (auto frames = receive_frames(*line.socket)) take(host, line, *frames);
        while (!line.relayed && !line.waiting.empty() && send(line, line.waiting.front())) line.waiting.pop_front();
        if (look && !line.relayed) look_whether_reachable(host, line, now);
    }
}

// [address][header][body]: a reply. Empty ones: the ask arrived damaged, or this is a new connection.
void HostLines::take(const std::string& host, Line& line, Frames& frames) {
    if (is_empty(frames)) {
        const bool expected = !std::exchange(line.greeted, true);
        const bool was_relayed = std::exchange(line.relayed, false);
        line.unreachable.reset();
        if (!expected || was_relayed) takers_.say_again(host);
        return;
    }
    const auto address = frames.size() == 3 ? unseal(bytes_of(frames[0])) : std::nullopt;
    if (!address || frames[1].size() == 0) return takers_.say_again(host);
    frames.erase(frames.begin());
    takers_.reply(address->place, frames);
}

void HostLines::look_whether_reachable(const std::string& host, Line& line, Time now) {
    if (line.socket->get(zmq::sockopt::events) & ZMQ_POLLOUT) return line.unreachable.reset();
    if (!line.unreachable) line.unreachable = now;
    if (now - *line.unreachable < unreachable_after) return;
    line.relayed = true;
    line.waiting.clear();  // places keep what is not answered
    takers_.say_again(host);
}

void HostLines::use(const Plan& plan) {
    std::erase_if(lines_, [&](const auto& line) {
        return std::none_of(plan.places.begin(), plan.places.end(),
                            [&](const PlaceAt& place) { return place.host == line.first; });
    });
}

bool HostLines::due(Time now) const { return waiting() || now - looked_ >= look_interval; }

bool HostLines::waiting() const {
    return std::any_of(lines_.begin(), lines_.end(), [](const auto& line) { return !line.second.waiting.empty(); });
}

std::vector<zmq::socket_t*> HostLines::sockets() {
    std::vector<zmq::socket_t*> sockets;
    for (auto& [host, line] : lines_)
        if (line.socket) sockets.push_back(line.socket.get());
    return sockets;
}

}  // namespace lightnet
