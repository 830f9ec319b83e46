#include "transport/joiners.hpp"

#include <algorithm>
#include <zmq.hpp>

#include "core/base/error.hpp"
#include "transport/cluster.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_joined = 4096;
constexpr auto joined_lease = std::chrono::milliseconds(1500);
constexpr std::size_t longest_name = 200;

std::string address_of(zmq::message_t& from) {
    const char* address = from.gets("Peer-Address");
    return address ? address : "";
}

// Where a host that listens on all its addresses can be called: at the one from which it dialled in.
std::string callable(const std::string& endpoint, zmq::message_t& from) {
    const std::string all = "tcp://0.0.0.0:";
    const auto address = address_of(from);
    if (!endpoint.starts_with(all) || address.empty()) return endpoint;
    return "tcp://" + address + ":" + endpoint.substr(all.size());
}

// A name that can't be taken for an endpoint, nor for the launcher.
bool is_name(const std::string& text) {
    return !text.empty() && text.size() <= longest_name &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > ' ' && c < 127 && c != '/'; });
}

}  // namespace

Joiners::Joiners(zmq::context_t& context, const std::string& endpoint, Pass pass)
    : keeper_(context), socket_(std::make_unique<zmq::socket_t>(door_socket(context))), pass_(std::move(pass)) {
    try {
        keeper_.guard(*socket_);
        socket_->bind(endpoint);
    } catch (const zmq::error_t& error) {
        throw Error(endpoint, std::string("can't listen there: ") + error.what());
    }
}

Joiners::~Joiners() = default;

std::string Joiners::endpoint() const { return socket_->get(zmq::sockopt::last_endpoint); }

std::vector<zmq::socket_t*> Joiners::sockets() {
    auto sockets = keeper_.sockets();
    sockets.push_back(socket_.get());
    return sockets;
}

std::uint64_t Joiners::receive(const Takers& takers) {
    keeper_.tick();
    std::uint64_t broken = 0;
    while (auto frames = receive_frames(*socket_)) {
        if (frames->size() == 3 && control(*frames, takers)) continue;
        const auto from = by_route_.find(text_of(frames->front()));
        if (from == by_route_.end()) {
            ++broken;
            continue;
        }
        auto& host = joined_.at(from->second);
        host.heard = Clock::now();
        frames->erase(frames->begin());
        host.line->arrived(std::move(*frames));
    }
    return broken;
}

// What concerns the port itself. False: it is for a host's line.
bool Joiners::control(Frames& frames, const Takers& takers) {
    const auto header = packet::peek_header(bytes_of(frames[1]));
    if (!header || (header->type != Type::join && header->type != Type::status)) return false;
    if (!packet::read_header(bytes_of(frames[1]), bytes_of(frames[2]))) return false;
    const auto fields = packet::unpack_fields(bytes_of(frames[2]));
    if (!fields) return false;
    const auto route = text_of(frames[0]);
    if (header->type == Type::status) {
        tell_state(route, takers.hosts());
    } else if (const bool expected = is_expected(*fields); !expected) {
        const bool turned_down = !fields->text("proof").empty();
        send(route, Type::joined, Fields{}.set("challenge", challenge_).set("turned_down", turned_down));
        if (turned_down && is_name(fields->text("name")))
            takers.turned_down(fields->text("name"), address_of(frames[2]));
        return fields->number("process") != 0;
    } else if (const auto& endpoint = fields->text("endpoint"); !endpoint.empty()) {
        if (!endpoint.starts_with("tcp://")) return false;
        try {
            takers.call(callable(endpoint, frames[2]));
        } catch (const zmq::error_t&) {  // not an endpoint at all
            return false;
        }
        send(route, Type::joined, Fields{}.set("challenge", challenge_));
    } else if (fields->number("process")) {
        join(route, *fields, takers);
    } else {
        return false;
    }
    return true;
}

bool Joiners::is_expected(const Fields& fields) const {
    const Pass::Claim claim{fields.text("name"), fields.number("process"), fields.text("endpoint")};
    return pass_.proves(challenge_, claim, fields.text("proof"));
}

void Joiners::join(const std::string& route, const Fields& fields, const Takers& takers) {
    const auto process = fields.number("process");
    send(route, Type::joined, Fields{}.set("challenge", challenge_));
    const auto name = name_for(fields.text("name"), process);
    if (!name || (!joined_.contains(*name) && joined_.size() >= most_joined)) return;
    auto& known = joined_[*name];
    if (!known.line) {
        auto line = std::make_unique<JoinedLine>(*socket_, route);
        known.line = line.get();
        takers.add(*name, std::move(line));
    } else if (known.line->route() != route) {
        by_route_.erase(known.line->route());
        known.line->use(route);
        takers.lost(*name, known.process == process ? "its connection was cut" : "it was started anew");
    }
    known.process = process;
    known.heard = Clock::now();
    by_route_[route] = *name;
}

// A host that was started anew gets the name that it had, as soon as it is clear that its predecessor is gone; of two
// that are both there, the later gets a number. None: not clear yet.
std::optional<std::string> Joiners::name_for(std::string wanted, std::uint64_t process) {
    if (!is_name(wanted)) wanted = "host";
    const auto now = Clock::now();
    for (int number = 1;; ++number) {
        const auto name = number == 1 ? wanted : wanted + "-" + std::to_string(number);
        const auto known = joined_.find(name);
        if (known == joined_.end() || known->second.process == process || now - known->second.heard > joined_lease) {
            rivals_.erase(process);
            return name;
        }
        if (rivals_.size() > most_joined) rivals_.clear();
        if (now - rivals_.try_emplace(process, now).first->second < joined_lease + std::chrono::milliseconds(500))
            return std::nullopt;
    }
}

void Joiners::tell_state(const std::string& route, const std::vector<HostState>& hosts) {
    for (std::size_t i = 0; i < hosts.size(); ++i) {
        Fields fields;
        set(fields, hosts[i].machine);
        fields.set("name", hosts[i].name).set("state", hosts[i].state).set("left", hosts.size() - 1 - i);
        fields.set("places", hosts[i].places).set("progress", hosts[i].progress);
        send(route, Type::state, fields);
    }
    if (hosts.empty()) send(route, Type::state, Fields{}.set("state", "a launcher without hosts"));
}

void Joiners::send(const std::string& route, Type type, const Fields& fields) {
    Frames frames;
    frames.push_back(frame_of(route));
    append(frames, packet::pack(type, 0, fields));
    send_frames(*socket_, frames);
}

}  // namespace lightnet
