#include "transport/launcher/host_connection.hpp"

#include <utility>

#include "core/base/ip_address.hpp"
#include "transport/lines/line_error.hpp"

namespace lightnet {
namespace {

constexpr auto old_line_lasts = std::chrono::seconds(10);  // for replies that are under way

}  // namespace

CalledConnection::CalledConnection(HostTransport& transport, std::string endpoint, std::optional<LineKeys> keys)
    : transport_(transport), endpoint_(std::move(endpoint)), keys_(std::move(keys)) {
    work_.line = transport_.connect(endpoint_, keys_, Handshakes::noted);
    open(files_);
}

// Behind two addresses of a name may be two hosts.
std::string CalledConnection::endpoint_of(const Lane& lane) const {
    if (&lane == &work_) return endpoint_;
    return work_.line ? work_.line->answering_at() : std::string();
}

bool CalledConnection::open(Lane& lane) {
    if (lane.line) return true;
    const auto endpoint = endpoint_of(lane);
    if (endpoint.empty()) return false;
    try {
        lane = {};
        lane.line = transport_.connect(endpoint, keys_, &lane == &files_ ? Handshakes::ignored : Handshakes::noted);
        return true;
    } catch (const LineError&) {  // out of descriptors, say
        lane = {};
        return false;
    }
}

void CalledConnection::tick(std::chrono::steady_clock::time_point now) {
    for (auto* lane : {&work_, &files_, &next_, &old_})
        if (lane->line) lane->line->tick(now);
}

bool CalledConnection::send(Frames& frames, bool files) {
    auto& lane = files ? files_ : work_;
    return open(lane) && lane.line->send(frames);
}

std::optional<Frames> CalledConnection::Lane::receive() {
    auto frames = line ? line->receive() : std::nullopt;
    if (frames && is_empty(*frames) && !std::exchange(greeted, true)) return receive();
    return frames;
}

std::optional<Frames> CalledConnection::receive() {
    for (auto* lane : {&work_, &old_, &files_})
        if (auto frames = lane->receive()) return frames;
    return std::nullopt;
}

std::optional<Handshake> CalledConnection::look_at_handshake() {
    return work_.line ? work_.line->look_at_handshake() : std::nullopt;
}

void CalledConnection::open_next() { open(next_); }

bool CalledConnection::send_on_next(Frames& frames) {
    if (!next_.line || !next_.line->send(frames)) return false;
    old_ = std::exchange(work_, std::exchange(next_, {}));
    old_since_ = std::chrono::steady_clock::now();
    return true;
}

bool CalledConnection::has_old(std::chrono::steady_clock::time_point now) {
    if (old_.line && now - old_since_ > old_line_lasts) old_ = {};
    return old_.line != nullptr;
}

void CalledConnection::renew() {
    // The old ones go first: there may be no descriptors for both.
    for (auto* lane : {&work_, &files_, &next_, &old_}) *lane = {};
    for (auto* lane : {&work_, &files_}) open(*lane);
}

void CalledConnection::call_at(std::uint16_t port) {
    if (auto parts = tcp_endpoint(endpoint_)) {
        parts->port = std::to_string(port);
        endpoint_ = parts->text();
    }
    renew();
}

void CalledConnection::watch(Poll& poll) const {
    for (const auto* lane : {&work_, &files_, &next_, &old_})
        if (lane->line) lane->line->watch(poll);
}

bool JoinedConnection::send(Frames& frames, bool) {
    frames.emplace(frames.begin(), route_);
    if (door_.send(frames) == SendResult::sent) return true;
    frames.erase(frames.begin());
    return false;
}

std::optional<Frames> JoinedConnection::receive() {
    if (arrived_.empty()) return std::nullopt;
    auto frames = std::move(arrived_.front());
    arrived_.pop_front();
    return frames;
}

void JoinedConnection::renew() { arrived_.clear(); }

void JoinedConnection::use(std::string route) {
    route_ = std::move(route);
    arrived_.clear();
}

void JoinedConnection::arrived(Frames frames) { arrived_.push_back(std::move(frames)); }

}  // namespace lightnet
