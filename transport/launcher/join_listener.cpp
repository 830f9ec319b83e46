#include "transport/launcher/join_listener.hpp"

#include <algorithm>

#include "core/base/ip_address.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/lines/line_error.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_joined = 4096;
constexpr auto joined_lease = std::chrono::milliseconds(1500);
constexpr std::size_t longest_name = 200;

// Where a host that listens on all its addresses can be called: at the one from which it dialled in. "": it listens in
// one family, and came by the other.
std::string callable(const std::string& endpoint, const std::string& address) {
    const auto parts = tcp_endpoint(endpoint);
    const auto number = parts ? ip_address(parts->host) : std::nullopt, from = ip_address(address);
    if (!number || !number->is_unspecified() || !from) return endpoint;
    if (from->six && !number->six) return {};
    return TcpEndpoint{address, parts->port}.text();
}

// A name that can't be taken for an endpoint, nor for the launcher.
bool is_name(const std::string& text) {
    return !text.empty() && text != own_process && text.size() <= longest_name &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > ' ' && c < 127 && c != '/'; });
}

}  // namespace

JoinListener::JoinListener(HostTransport& transport, const std::string& endpoint, Pass pass)
    : JoinListener(transport, endpoint, std::optional(std::move(pass)), std::nullopt) {}

JoinListener::JoinListener(HostTransport& transport, const std::string& endpoint, Door door)
    : JoinListener(transport, endpoint, std::nullopt, std::optional(std::move(door))) {}

JoinListener::JoinListener(HostTransport& transport, const std::string& endpoint, std::optional<Pass> pass,
                           std::optional<Door> door)
    : pass_(std::move(pass)), door_(std::move(door)), port_(transport.listen(endpoint, keys_of_door())) {}

std::optional<DoorKeys> JoinListener::keys_of_door() {
    if (!door_) return std::nullopt;
    return DoorKeys{door_->own, [this](const PublicKey& key) { return key == door_->own.open || listed_name(key); },
                    [this](const PublicKey& key, const std::string& address) {
                        if (told_.size() >= most_joined || !told_.insert(key).second) return;
                        door_->say("turned away " + address + ": its key (fingerprint " + key.fingerprint() +
                                   ") is not on the list; to let it in, append this line to that of --allow: " +
                                   key.text() + " NAME");
                    }};
}

std::optional<std::string> JoinListener::listed_name(const PublicKey& key) const {
    const auto& [file, more] = door_->keys;
    const auto name = more.name_of(key);
    return name || !file ? name : file->list().name_of(key);
}

// DECISIONS: rights-by-key
JoinListener::Sender JoinListener::who_says_it() const {
    if (!door_) return {};
    const auto key = PublicKey::from(port_->key());
    if (!key) return {std::nullopt, {}, Party::stranger};
    if (*key == door_->own.open) return {key, {}, Party::user};
    const auto name = listed_name(*key);
    return {key, name.value_or(""), name ? Party::host : Party::stranger};
}

bool JoinListener::may_say(const Sender& sender, const Frames& frames) const {
    if (!door_) return true;
    const auto header = frames.size() >= 3 ? packet::peek_header(bytes_of(frames[frames.size() - 2])) : std::nullopt;
    return header ? may(sender.party, header->type) : sender.party == Party::host;
}

// Whose key is taken off the list is a stranger from then on.
void JoinListener::look_at_list(const Handlers& handlers) {
    if (!door_ || !door_->keys.file || !door_->keys.file->refresh(Clock::now(), door_->say)) return;
    for (const auto& [name, host] : joined_)
        if (host.key && !listed_name(*host.key)) handlers.lost(name, "its key was taken off the list");
}

std::uint64_t JoinListener::receive(const Handlers& handlers) {
    look_at_list(handlers);
    port_->let_in();
    std::uint64_t broken = 0;
    while (auto frames = port_->receive()) {
        const auto sender = who_says_it();
        if (!may_say(sender, *frames)) {
            ++broken;
            continue;
        }
        if (frames->size() == 3 && control(*frames, sender, handlers)) continue;
        const auto from = by_route_.find(text_of(frames->front()));
        if (from == by_route_.end()) {
            ++broken;
            continue;
        }
        auto& host = joined_.at(from->second);
        host.heard = Clock::now();
        frames->erase(frames->begin());
        host.connection->arrived(std::move(*frames));
    }
    return broken;
}

// What concerns the port itself. False: it is for a host's connection.
bool JoinListener::control(Frames& frames, const Sender& sender, const Handlers& handlers) {
    const auto header = packet::peek_header(bytes_of(frames[1]));
    if (!header || (header->type != Type::join && header->type != Type::status)) return false;
    if (!packet::read_header(bytes_of(frames[1]), bytes_of(frames[2]))) return false;
    const auto fields = packet::unpack_fields(bytes_of(frames[2]));
    if (!fields) return false;
    const auto route = text_of(frames[0]);
    if (header->type == Type::join) return take_join(route, *fields, port_->address(), sender, handlers);
    tell_state(route, handlers.hosts(), !door_ || sender.party == Party::user);
    return true;
}

bool JoinListener::take_join(const std::string& route, const Fields& fields, const std::string& address,
                             const Sender& sender, const Handlers& handlers) {
    const auto endpoint = callable(fields.text("endpoint"), address);
    if (!is_expected(fields)) {
        challenge(route, fields, address, handlers);
        return fields.number("process") != 0;
    }
    if (endpoint.empty()) {
        if (fields.number("process")) join(route, fields, sender, handlers);
        return fields.number("process") != 0;
    }
    const auto parts = tcp_endpoint(endpoint);
    if (!parts || !ip_address(parts->host))
        return false;  // a host knows where it listens: no names are looked up for it
    try {
        handlers.call(endpoint, sender.key);
    } catch (const LineError&) {  // not an endpoint at all
        return false;
    }
    send(route, Type::joined, Fields{}.set("challenge", challenge_));
    return true;
}

void JoinListener::challenge(const std::string& route, const Fields& fields, const std::string& address,
                             const Handlers& handlers) {
    const bool turned_down = !fields.text("proof").empty();
    send(route, Type::joined, Fields{}.set("challenge", challenge_).set("turned_down", turned_down));
    if (turned_down && is_name(fields.text("name"))) handlers.turned_down(fields.text("name"), address);
}

// Whose key is on the list has proved it by coming in.
bool JoinListener::is_expected(const Fields& fields) const {
    const Pass::Claim claim{fields.text("name"), fields.number("process"), fields.text("endpoint")};
    return !pass_ || pass_->proves(challenge_, claim, fields.text("proof"));
}

void JoinListener::join(const std::string& route, const Fields& fields, const Sender& sender,
                        const Handlers& handlers) {
    const auto process = fields.number("process");
    send(route, Type::joined, Fields{}.set("challenge", challenge_));
    const auto name = name_for(sender.key ? called(sender.listed, fields.text("name")) : fields.text("name"), process);
    if (!name || (!joined_.contains(*name) && joined_.size() >= most_joined)) return;
    auto& known = joined_[*name];
    known.key = sender.key;
    if (!known.connection) {
        auto connection = std::make_unique<JoinedConnection>(*port_, route);
        known.connection = connection.get();
        handlers.add(*name, std::move(connection), sender.key);
    } else if (known.connection->route() != route) {
        by_route_.erase(known.connection->route());
        known.connection->use(route);
        handlers.lost(*name, known.process == process ? "its connection was cut" : "it was started anew");
    }
    known.process = process;
    known.heard = Clock::now();
    by_route_[route] = *name;
}

// A host that was started anew gets the name that it had, as soon as it is clear that its predecessor is gone; of two
// that are both there, the later gets a number. None: not clear yet.
std::optional<std::string> JoinListener::name_for(std::string wanted, std::uint64_t process) {
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

// `all`: what is nobody's business but the user's, too.
void JoinListener::tell_state(const std::string& route, const std::vector<HostState>& hosts, bool all) {
    for (std::size_t i = 0; i < hosts.size() && all; ++i) {
        Fields fields;
        set(fields, hosts[i].machine);
        fields.set("name", hosts[i].name).set("state", hosts[i].state).set("left", hosts.size() - 1 - i);
        fields.set("places", hosts[i].places).set("progress", hosts[i].progress);
        send(route, Type::state, fields);
    }
    if (!all) return send(route, Type::state, Fields{}.set("state", "a launcher"));
    if (hosts.empty()) send(route, Type::state, Fields{}.set("state", "a launcher without hosts"));
}

void JoinListener::send(const std::string& route, Type type, const Fields& fields) {
    Frames frames;
    frames.emplace_back(route);
    append(frames, packet::pack(type, 0, fields));
    port_->send(frames);
}

}  // namespace lightnet
