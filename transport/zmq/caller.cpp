#include "transport/zmq/caller.hpp"

#include <zmq.hpp>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <utility>

namespace lightnet {
namespace {

constexpr auto look_interval = std::chrono::milliseconds(20);
constexpr auto fresh = std::chrono::seconds(2);  // as long as nobody answers, a name is asked for so often

TcpEndpoint parts_of(const std::string& endpoint) {
    auto parts = tcp_endpoint(endpoint);
    if (!parts) throw SocketError(EINVAL);
    return std::move(*parts);
}

}  // namespace

Caller::Caller(const SocketContext& context, std::string endpoint, std::optional<LineKeys> keys, Handshakes handshakes)
    : context_(&context),
      endpoint_(std::move(endpoint)),
      parts_(parts_of(endpoint_)),
      keys_(std::move(keys)),
      notes_handshakes_(handshakes == Handshakes::noted) {
    const auto now = std::chrono::steady_clock::now();
    if (const auto number = ip_address(parts_.host)) {
        by_number_ = true;
        turns_.use({*number}, now);
        call(*number);
    } else {
        tick(now);
    }
}

void Caller::call(const IpAddress& address) {
    socket_.reset();  // first: there may be no descriptors for both
    called_.reset();
    handshakes_.begin();
    const TcpEndpoint there{address.text(), parts_.port};
    auto socket = unconnected_asking_socket(*context_, there.text(), keys_);
    // An attempt that is closed has failed; of what was connected it is told otherwise. To note them costs descriptors.
    const int ends = by_number_ ? 0 : ZMQ_EVENT_CLOSED | ZMQ_EVENT_DISCONNECTED;
    if (notes_handshakes_ || !by_number_) socket.note_events(*context_, handshake_events() | ends);
    socket.connect(there.text());
    socket_ = std::move(socket);
    called_ = address;
}

void Caller::look_at_events(Time now) {
    while (const auto event = socket_ ? socket_->next_event() : std::nullopt) {
        if (event->number == ZMQ_EVENT_CLOSED) turns_.refused();
        if (event->number == ZMQ_EVENT_DISCONNECTED) turns_.cut(now);
        const auto seen = handshakes_.see(*event, now);
        if (!seen) continue;
        const bool made = *seen == Handshake::made;
        // Behind another address may be who is meant.
        if (made || turns_.all().empty() || *called_ == turns_.all().back()) handshakes_.last = seen;
        if (!made) {
            turns_.refused();
            continue;
        }
        turns_.answered();
        if (!by_number_) context_->names().remember(endpoint_, *called_);
    }
}

void Caller::tick(Time now) {
    look_at_events(now);
    if (by_number_ || now < next_look_) return;
    next_look_ = now + look_interval;
    if (turns_.is_answered()) return;
    known_ = context_->names().look(parts_.host, now, fresh);
    auto addresses = known_.addresses;
    std::copy_if(heard_.begin(), heard_.end(), std::back_inserter(addresses), [&](const auto& one) {
        return std::find(known_.addresses.begin(), known_.addresses.end(), one) == known_.addresses.end();
    });
    if (const auto last = context_->names().remembered(endpoint_))
        std::stable_partition(addresses.begin(), addresses.end(), [&](const auto& one) { return one == *last; });
    turns_.use(addresses, now);
    const auto due = turns_.due(now);
    if (!due || due == called_) return;
    try {
        call(*due);
    } catch (const SocketError&) {  // out of descriptors, say: later, then
    }
}

void Caller::watch(Poll& poll) const {
    if (!socket_) return;
    poll.add(*socket_);
    if (!by_number_) poll.add(*socket_->events());
}

std::optional<Handshake> Caller::look_at_handshake() {
    look_at_events(std::chrono::steady_clock::now());
    return std::exchange(handshakes_.last, std::nullopt);
}

std::string Caller::answering_at() const {
    if (by_number_) return endpoint_;
    return turns_.is_answered() && called_ ? TcpEndpoint{called_->text(), parts_.port}.text() : std::string();
}

std::string Caller::trouble() const {
    if (by_number_) return called_ ? missing_card(*called_) : std::string();
    if (turns_.is_answered()) return {};
    if (!known_.why.empty()) return known_.why;
    std::string addresses;
    for (const auto& one : turns_.all()) addresses += (addresses.empty() ? "" : ", ") + one.text();
    return addresses.empty() ? "it is still asked where '" + parts_.host + "' is"
                             : "'" + parts_.host + "' is " + addresses;
}

}  // namespace lightnet
