#include "transport/daemon/peer_connections.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/ip_address.hpp"
#include "transport/lines/line_error.hpp"
#include "transport/wire/relay_address.hpp"

namespace lightnet {
namespace {

constexpr auto unreachable_after = std::chrono::seconds(1);  // then the launcher passes on what is for that host
constexpr auto look_interval = std::chrono::milliseconds(200);
constexpr auto call_interval = std::chrono::milliseconds(500);
constexpr auto shortest_lease = std::chrono::milliseconds(2500), longest_lease = std::chrono::milliseconds(10000);
// A line is quick that has carried half a MiB/s, and on which little is before a word and its answer.
constexpr std::size_t quick_window = 256 << 10;
constexpr auto quick_answer = std::chrono::milliseconds(300);

}  // namespace

PeerConnections::PeerConnections(HostTransport& transport, std::string me, Handlers handlers,
                                 std::chrono::milliseconds line_life)
    : transport_(transport), me_(std::move(me)), handlers_(std::move(handlers)), line_life_(line_life) {}

PeerConnections::Peer& PeerConnections::peer(const std::string& host) {
    const auto [found, fresh] = peers_.try_emplace(host);
    auto& to = found->second;
    if (!fresh) return to;
    try {
        if (calls_directly(me_, host)) open(host, to);
    } catch (const LineError&) {  // out of descriptors, say: the launcher has a connection already
    }
    to.relayed = !to.line;
    return to;
}

void PeerConnections::open(const std::string& host, Peer& to) {
    to.line.reset();  // first: there may be no descriptors for both
    to.line = transport_.connect(addresses_.endpoint_of(host), handlers_.keys(host));
    if (auto at = addresses_.of(host); !at.empty()) to.line->hear(std::move(at));
    to.paced.restart();
    to.opened = to.called = std::chrono::steady_clock::now();
    to.lease = Lease(call_interval, shortest_lease, longest_lease);
    to.lease.begin(to.opened);
    to.calling = false;
    to.number = ++opened_;
}

void PeerConnections::hear(const std::string& lines) {
    const bool ports_changed = addresses_.hear(lines);
    for (auto& [host, to] : peers_) {
        if (!to.line) continue;
        if (ports_changed) open_anew(host, to);
        if (auto at = addresses_.of(host); to.line && !at.empty()) to.line->hear(std::move(at));
    }
}

void PeerConnections::ask(Frames frames) {
    auto& to = peer(text_of(frames[1]));
    if (to.relayed) return handlers_.launcher(frames);
    Frames packet;
    packet.emplace_back(seal({me_, text_of(frames[0])}));
    for (const auto i : {2u, 3u}) packet.push_back(std::move(frames[i]));
    if (!to.paced.send(packet, std::chrono::steady_clock::now(), to.socket())) to.paced.put(std::move(packet));
}

std::vector<std::string> PeerConnections::nearest(std::vector<std::string> hosts) {
    std::erase_if(hosts, [&](const auto& host) { return peer(host).relayed; });
    const auto machine_of = [](const std::string& host) {
        const auto parts = tcp_endpoint(host);
        return parts ? parts->host : host;
    };
    std::ranges::stable_sort(hosts, std::ranges::greater{}, [&](const auto& host) {
        const auto& to = peers_.at(host);
        return std::tuple(machine_of(host) == machine_of(me_), !to.slow, to.paced.window());
    });
    return hosts;
}

void PeerConnections::tick(Time now) {
    const bool look = now - looked_ >= look_interval;
    if (look) looked_ = now;
    for (auto& [host, to] : peers_) {
        if (!to.line) continue;
        to.line->tick(now);
        while (auto frames = to.line->receive()) {
            to.lease.heard(now);
            if (std::exchange(to.calling, false)) to.slow = now - to.called > quick_answer;
            if (auto message = to.paced.take(std::move(*frames), now, to.socket())) take(host, to, *message);
            to.relayed = false;
        }
        if (!to.relayed) to.paced.go_on(now, to.socket());
        if (look && now - to.opened > line_life_ && handlers_.keys(host)) open_anew(host, to);
        if (look && to.line && !to.relayed) look_whether_reachable(host, to, now);
        if (look && to.line && !to.relayed) look_whether_silent(host, to, now);
    }
    if (look) tell_quick();
}

// [address][header][body]: a reply. Empty ones: the ask arrived damaged, or this is a new connection.
void PeerConnections::take(const std::string& host, Peer& to, Frames& frames) {
    if (is_empty(frames)) {
        const bool expected = !std::exchange(to.greeted, true);
        const bool was_relayed = std::exchange(to.relayed, false);
        to.unreachable.reset();
        if (!expected) to.paced.restart();
        if (!expected || was_relayed) handlers_.request_resend(host);
        return;
    }
    const auto address = frames.size() == 3 ? unseal(bytes_of(frames[0])) : std::nullopt;
    if (!address || frames[1].size() == 0) return handlers_.request_resend(host);
    frames.erase(frames.begin());
    handlers_.reply(host, address->place, frames);
}

// The greeting on the new line has all asked again that is under way.
// DECISIONS: lines-are-renewed
void PeerConnections::open_anew(const std::string& host, Peer& to) {
    to.greeted = true;
    try {
        open(host, to);
    } catch (const LineError&) {  // out of descriptors, say
        to.relayed = true;
    }
}

void PeerConnections::look_whether_reachable(const std::string& host, Peer& to, Time now) {
    if (to.line->can_send()) return to.unreachable.reset();
    if (!to.unreachable) to.unreachable = now;
    if (now - *to.unreachable >= unreachable_after) give_up(host, to);
}

void PeerConnections::give_up(const std::string& host, Peer& to) {
    to.relayed = true;
    tell_quick();             // first: what is sent again shall not go the same way
    to.paced.drop_waiting();  // places keep what is not answered
    handlers_.request_resend(host);
}

// ZeroMQ's own heartbeats are patient, as they wait behind what is under way. The line stays, and is taken again when
// the host is heard on it or its connection is made anew.
void PeerConnections::look_whether_silent(const std::string& host, Peer& to, Time now) {
    if (now - std::max(to.lease.last_heard(), to.called) > call_interval) {
        to.called = now;
        auto call = frames_of(packet::pack(packet::Type::mark, std::uint64_t{0}));
        to.calling = to.line->send(call);
    }
    to.slow |= to.calling && now - to.called > quick_answer;
    if (to.lease.is_over(now, to.paced.expected())) give_up(host, to);
}

bool PeerConnections::is_quick(const Peer& to) const {
    return to.line && !to.relayed && !to.slow && to.paced.window() >= quick_window && to.line->is_open_to_places() &&
           !to.line->answering_at().empty();
}

void PeerConnections::tell_quick() const {
    LineBook::Entries quick;
    for (const auto& [host, to] : peers_)
        if (is_quick(to)) quick[host] = {to.line->answering_at(), handlers_.keys(host), to.number, to.paced.window()};
    handlers_.quick(std::move(quick), hosts_);
}

void PeerConnections::use(const Plan& plan) {
    std::set<std::string> hosts;
    for (const auto& place : plan.places)
        if (place.host != me_) hosts.insert(place.host);
    hosts_ = hosts.size();
    std::erase_if(peers_, [&](const auto& peer) {
        return std::none_of(plan.places.begin(), plan.places.end(),
                            [&](const PlaceAt& place) { return place.host == peer.first; });
    });
}

bool PeerConnections::due(Time now) const { return waiting() || now - looked_ >= look_interval; }

bool PeerConnections::waiting() const {
    return std::any_of(peers_.begin(), peers_.end(), [](const auto& peer) { return peer.second.paced.refused(); });
}

void PeerConnections::watch(Poll& poll) const {
    for (const auto& [host, to] : peers_)
        if (to.line) to.line->watch(poll);
}

}  // namespace lightnet
