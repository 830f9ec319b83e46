#include "transport/zmq/doorkeeper.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <zmq.hpp>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "transport/places/descriptors.hpp"
#include "transport/zmq/door_trial.hpp"

namespace lightnet {
namespace {

// DECISIONS: guarded-port
constexpr const char* authentication = "inproc://zeromq.zap.01";  // the name is ZeroMQ's
// ZMQ_ZAP_ENFORCE_DOMAIN: without a doorkeeper nobody gets in; not in all headers
constexpr zmq::sockopt::integral_option<93, int, true> enforce_domain{};
constexpr std::size_t for_own_work = 64, most_let_in = 4096, least_let_in = 8;

// One of the old family comes in the new one's clothes at a port for both.
std::string usual_number(const std::string& text) {
    const auto number = ip_address(text);
    return number ? number->text() : text;
}

constexpr int watched = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                        ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

// False: the library is too old to know it.
bool enforces_domain(const Socket& door) try {
    door.library().set(enforce_domain, true);
    return true;
} catch (const zmq::error_t&) {
    return false;
}

}  // namespace

std::size_t most_peers(std::size_t left) {
    return std::clamp(left > for_own_work ? (left - for_own_work) / 2 : 0, least_let_in, most_let_in);
}

Doorkeeper::Doorkeeper(const SocketContext& context, std::optional<Keys> keys)
    : context_(context), keys_(std::move(keys)), requests_(context, ZMQ_REP) {
    requests_.bind(authentication);
}

void Doorkeeper::guard(Socket& door) {
    door.library().set(zmq::sockopt::zap_domain, "lightnet");
    if (!enforces_domain(door) && keys_)
        throw Error("this libzmq can't be trusted with keys: it lacks ZMQ_ZAP_ENFORCE_DOMAIN");
    if (keys_) door.answer_with(keys_->own);
    door.note_events(context_, watched);
    doors_.push_back(&door);
}

void Doorkeeper::try_out(const Socket& door) {
    if (!keys_) return;
    on_trial_ = true;
    try_door(door.endpoint(), keys_->own.open, [this] { tick(); });
    on_trial_ = false;
}

void Doorkeeper::watch(Poll& poll) const {
    poll.add(requests_);
    for (const auto* door : doors_) poll.add(*door->events());
}

void Doorkeeper::tick() {
    for (auto* door : doors_) count_peers(*door);
    while (auto request = requests_.receive()) answer(*request);
}

void Doorkeeper::count_peers(Socket& door) {
    while (const auto event = door.next_event()) {
        if (event->number == ZMQ_EVENT_ACCEPTED) peers_.insert(event->value);
        if (event->number == ZMQ_EVENT_DISCONNECTED) peers_.erase(event->value);
        if (event->number == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL && keys_) keys_->no_key();
    }
}

// Looking at all descriptors takes time, and connections may come in floods.
std::size_t Doorkeeper::most_now() {
    const auto now = std::chrono::steady_clock::now();
    if (now - counted_ > std::chrono::seconds(1)) {
        most_ = most_peers(descriptors_left() + peers_.size());
        counted_ = now;
    }
    return most_;
}

// The code by which it is answered, and who it is.
const char* Doorkeeper::verdict(const Frames& request, std::string& who) {
    constexpr std::size_t mechanism = 5, key = 6;
    if (request.size() <= mechanism || text_of(request[0]) != "1.0") return "400";
    if (peers_.size() > most_now()) {
        ++turned_away_;
        // With keys it is to try again; 400 would say that its key is not known.
        return keys_ ? "300" : "400";
    }
    if (!keys_) return "200";
    PublicKey theirs;
    if (text_of(request[mechanism]) != "CURVE" || request.size() <= key || request[key].size() != theirs.bytes.size())
        return "400";
    std::memcpy(theirs.bytes.data(), request[key].data(), theirs.bytes.size());
    who = theirs.text();
    if (keys_->knows(theirs)) return "200";
    ++turned_away_;
    if (!on_trial_) keys_->turned_away(theirs, usual_number(text_of(request[3])));
    return "400";
}

// [version][request][domain][address][identity][mechanism][key]… → [version][request][code][text][user][metadata]
void Doorkeeper::answer(Frames& request) {
    std::string who;
    const std::string code = verdict(request, who);
    Frames reply;
    reply.emplace_back("1.0");
    reply.push_back(request.size() > 1 ? std::move(request[1]) : MessageFrame());
    reply.emplace_back(code);
    reply.emplace_back(code == "200" ? "" : "not let in");
    reply.emplace_back(code == "200" ? who : "");
    reply.emplace_back("");
    requests_.send(reply);
}

}  // namespace lightnet
