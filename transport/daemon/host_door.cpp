#include "transport/daemon/host_door.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using packet::Fields;
using packet::Type;

constexpr auto join_interval = 500ms;
constexpr int abandoned_for_sure = 3;  // handshakes: a line may be cut in the middle of one
constexpr auto shortest_silence = 2000ms, longest_silence = 10'000ms;

// ZeroMQ's own routes begin with a zero.
const std::string launcher_route = "launcher";

bool is_counted(const Frames& frames) {
    if (frames.size() < 3) return false;
    const auto header = packet::peek_header(bytes_of(frames[frames.size() - 2]));
    return header && packet::is_counted(header->type);
}

}  // namespace

HostDoor::HostDoor(const SocketContext& context, Options options)
    : context_(context), options_(std::move(options)), silence_(shortest_silence) {
    if (!options_.listen.empty()) {
        keeper_.emplace(context_, options_.keys);
        port_.emplace(door_socket(context_));
        keeper_->guard(*port_);
        listen(*port_, context_, options_.listen);
        keeper_->try_out(*port_);
    }
    if (!options_.join.empty()) dial(std::chrono::steady_clock::now());
}

std::string HostDoor::endpoint() const { return port_ ? port_->endpoint() : std::string(); }

void HostDoor::dial(Time now) {
    launcher_.reset();  // first: there may be no descriptors for both
    challenge_.clear();
    heard_ = dialled_ = now;
    next_join_ = {};
    try {
        launcher_.emplace(context_, options_.join, options_.launcher, Caller::Handshakes::noted);
    } catch (const SocketError& error) {
        if (error.out_of_descriptors()) return;  // later, then
        throw Error(options_.join, std::string("can't be dialled: ") + error.what());
    }
}

// A launcher lets in who proves that he knows the pass of its user.
void HostDoor::take_challenge(const Frames& frames) {
    if (frames.size() != 3) return;
    const auto header = packet::read_header(bytes_of(frames[1]), bytes_of(frames[2]));
    if (!header || header->type != Type::joined) return;
    const auto fields = packet::unpack_fields(bytes_of(frames[2]));
    if (!fields || fields->text("challenge").empty()) return;
    if (fields->number("turned_down") && !std::exchange(turned_down_, true))
        options_.log({LogLevel::warning, "the launcher at " + options_.join +
                                             " does not let this host in: its user has another pass (give both the "
                                             "same file, --pass)"});
    if (challenge_ == fields->text("challenge")) return;
    challenge_ = fields->text("challenge");
    next_join_ = {};
}

// Once: it goes on dialling, as a launcher may learn its key, or another may come.
void HostDoor::look_at_handshake() {
    const auto seen = launcher_ ? launcher_->look_at_handshake() : std::nullopt;
    if (!seen) return;
    abandoned_ = *seen == Handshake::abandoned ? abandoned_ + 1 : 0;
    if (*seen == Handshake::made) told_trouble_ = false, known_ = true;
    const bool for_sure = *seen == Handshake::mismatched || abandoned_ >= abandoned_for_sure;
    std::string trouble;
    if (*seen == Handshake::refused && options_.launcher)
        trouble = "does not know the key of this host (fingerprint " + options_.launcher->own.open.fingerprint() +
                  "); to be let in, its user appends to the list of --allow: " + options_.launcher->own.open.text() +
                  " " + options_.name;
    else if (for_sure && *seen == Handshake::abandoned && (known_ || !options_.launcher))
        trouble = "ends each connection before a word is said: its line may be cut" +
                  std::string(known_ ? "" : ", or it has a key, which --launcher-key would say");
    else if (for_sure && options_.launcher)
        trouble = "has another key than --launcher-key says (fingerprint " + options_.launcher->theirs.fingerprint() +
                  "), or none";
    else if (for_sure)
        trouble = "asks for keys: say --launcher-key KEY, which its user knows (lightnet key)";
    if (!trouble.empty() && !std::exchange(told_trouble_, true))
        options_.log({LogLevel::warning, "the launcher at " + options_.join + " " + trouble});
}

std::string HostDoor::key_of(const Frames& frames) const {
    if (text_of(frames.front()) != launcher_route) return std::string(frames.back().peer_key());
    return options_.launcher ? options_.launcher->theirs.text() : std::string();
}

std::optional<Frames> HostDoor::from_launcher(Time now) {
    while (auto frames = launcher_->receive()) {
        heard_ = now;
        silence_ = shortest_silence;
        if (frames->size() == 1 && is_empty(*frames)) next_join_ = {};  // a new connection: it does not know us yet
        frames->emplace(frames->begin(), launcher_route);
        take_challenge(*frames);
        return frames;
    }
    return std::nullopt;
}

std::optional<Frames> HostDoor::receive(Time now) {
    auto frames = from_anyone(now);
    if (frames && text_of(frames->front()) == counted_ && is_counted(*frames)) ++tally_.taken;
    return frames;
}

std::optional<Frames> HostDoor::from_anyone(Time now) {
    if (port_)
        if (auto frames = port_->receive()) return frames;
    return launcher_ ? from_launcher(now) : std::nullopt;
}

bool HostDoor::send(Frames& frames) {
    if (text_of(frames.front()) == counted_ && is_counted(frames)) ++tally_.told;  // even if it is lost right here
    if (text_of(frames.front()) != launcher_route) return port_ && port_->send(frames);
    frames.erase(frames.begin());
    return launcher_ && launcher_->send(frames);
}

void HostDoor::send(const std::string& route, Type type, std::uint64_t run, const Fields& fields) {
    Frames frames;
    frames.emplace_back(route);
    append(frames, packet::pack(type, run, fields));
    send(frames);
}

void HostDoor::keep_in_touch(Time now) {
    if (options_.join.empty()) return;
    if (launcher_) launcher_->tick(now);
    look_at_handshake();
    // DECISIONS: lines-are-renewed
    if (options_.launcher && now - dialled_ > options_.line_life) dial(now);
    if (now - heard_ > silence_) {
        // Half of the connection may be gone without a word.
        silence_ = std::min<std::chrono::milliseconds>(2 * silence_, longest_silence);
        dial(now);
    }
    if (!launcher_ || now < next_join_) return;
    next_join_ = now + join_interval;
    const Pass::Claim claim{options_.name, options_.process, endpoint()};
    Fields fields;
    fields.set("name", claim.name).set("process", claim.process).set("endpoint", claim.endpoint);
    if (!challenge_.empty() && options_.pass) fields.set("proof", options_.pass->proof(challenge_, claim));
    auto frames = frames_of(packet::pack(Type::join, 0, fields));
    if (!launcher_->send(frames)) next_join_ = now + 20ms;
}

void HostDoor::count(const std::string& route) {
    if (route == counted_) return;
    counted_ = route;
    tally_ = {tally_.line + 1, 0, 0};
}

void HostDoor::let_in() {
    if (keeper_) keeper_->tick();
}

void HostDoor::watch(Poll& poll) const {
    if (keeper_) keeper_->watch(poll);
    if (port_) poll.add(*port_);
    if (launcher_) launcher_->watch(poll);
}

}  // namespace lightnet
