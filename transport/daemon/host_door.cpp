#include "transport/daemon/host_door.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/run/assembly/job.hpp"
#include "transport/lines/line_error.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using packet::Fields;
using packet::Type;

constexpr auto join_interval = 500ms;
constexpr int abandoned_for_sure = 3;  // handshakes: a line may be cut in the middle of one
constexpr std::size_t many_lines = 256;
constexpr auto unused_for = 10s;
constexpr auto shortest_silence = 2000ms, longest_silence = 10'000ms;

// ZeroMQ's own routes begin with a zero.
const std::string launcher_route = "launcher";

bool is_counted(const Frames& frames) {
    if (frames.size() < 3) return false;
    const auto header = packet::peek_header(bytes_of(frames[frames.size() - 2]));
    return header && packet::is_counted(header->type);
}

}  // namespace

HostDoor::HostDoor(HostTransport& transport, Options options)
    : transport_(transport), options_(std::move(options)), silence_(shortest_silence) {
    if (!options_.listen.empty()) port_ = transport_.listen(options_.listen, options_.keys);
    if (!options_.join.empty()) dial(std::chrono::steady_clock::now());
}

std::string HostDoor::endpoint() const { return port_ ? port_->endpoint() : std::string(); }

void HostDoor::dial(Time now) {
    begin_anew(launcher_route);
    launcher_.reset();  // first: there may be no descriptors for both
    challenge_.clear();
    heard_ = dialled_ = now;
    next_join_ = {};
    try {
        launcher_ = transport_.connect(options_.join, options_.launcher, Handshakes::noted);
    } catch (const LineError& error) {
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
    if (fields->number("turned_down") && !std::exchange(known_.turned_down, true))
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
    known_.abandoned = *seen == Handshake::abandoned ? known_.abandoned + 1 : 0;
    if (*seen == Handshake::made) known_.told = false, known_.made = true;
    const bool for_sure = *seen == Handshake::mismatched || known_.abandoned >= abandoned_for_sure;
    std::string trouble;
    if (*seen == Handshake::refused && options_.launcher)
        trouble = "does not know the key of this host (fingerprint " + options_.launcher->own.open.fingerprint() +
                  "); to be let in, its user appends to the list of --allow: " + options_.launcher->own.open.text() +
                  " " + options_.name;
    else if (for_sure && *seen == Handshake::abandoned && (known_.made || !options_.launcher))
        trouble = "ends each connection before a word is said: its line may be cut" +
                  std::string(known_.made ? "" : ", or it has a key, which --launcher-key would say");
    else if (for_sure && options_.launcher)
        trouble = "has another key than --launcher-key says (fingerprint " + options_.launcher->theirs.fingerprint() +
                  "), or none";
    else if (for_sure)
        trouble = "asks for keys: say --launcher-key KEY, which its user knows (lightnet key)";
    if (!trouble.empty() && !std::exchange(known_.told, true))
        options_.log({LogLevel::warning, "the launcher at " + options_.join + " " + trouble});
}

std::optional<Frames> HostDoor::from_launcher(Time now) {
    while (auto frames = launcher_->receive()) {
        heard_ = now;
        silence_ = shortest_silence;
        known_.silence.clear();
        if (frames->size() == 1 && is_empty(*frames)) {
            next_join_ = {};  // a new connection: it does not know us yet
            begin_anew(launcher_route);
        }
        frames->emplace(frames->begin(), launcher_route);
        take_challenge(*frames);
        return frames;
    }
    return std::nullopt;
}

std::optional<Frames> HostDoor::receive(Time now) {
    while (auto frames = from_anyone(now)) {
        auto message = take(std::move(*frames), now);
        if (!message) continue;
        if (text_of(message->front()) == counted_) {
            tally_.heard = now;
            tally_.taken += is_counted(*message);
        }
        return message;
    }
    return std::nullopt;
}

std::optional<Frames> HostDoor::from_anyone(Time now) {
    if (port_)
        if (auto frames = port_->receive()) {
            key_ = port_->key();
            return frames;
        }
    key_ = options_.launcher ? options_.launcher->theirs.text() : std::string();
    return launcher_ ? from_launcher(now) : std::nullopt;
}

// Puts together what comes in parts, and answers marks.
std::optional<Frames> HostDoor::take(Frames frames, Time now) {
    const auto header = frames.size() == 3 ? packet::peek_header(bytes_of(frames[1])) : std::nullopt;
    if (!header || header->type < Type::part) return frames;
    const auto route = text_of(frames[0]);
    if (header->type == Type::part && !may_come_in_parts(frames, route)) return std::nullopt;
    frames.erase(frames.begin());
    auto message = line_to(route, now).line.take(std::move(frames), now, [&](Frames& answer) {
        return send_at_once(route, answer);
    });
    if (message) message->emplace(message->begin(), route);
    return message;
}

// Strangers may only begin a run so, and all of them together get room for one job.
bool HostDoor::may_come_in_parts(const Frames& frames, const std::string& route) const {
    const auto header = packet::peek_header(bytes_of(frames[1]));
    if (route == counted_ || (run_ && header->run == run_)) return true;
    std::size_t room = most_job_bytes;
    for (const auto& [other, to] : lines_) room -= std::min(room, other == counted_ ? 0 : to.line.incomplete());
    return frames[2].size() <= room;
}

HostDoor::Line& HostDoor::line_to(const std::string& route, Time now) {
    if (lines_.size() >= many_lines && !lines_.contains(route))
        std::erase_if(lines_, [&](const auto& one) {
            return one.first != counted_ && !one.second.line.waiting() && now - one.second.used > unused_for;
        });
    auto& line = lines_[route];
    line.used = now;
    return line;
}

bool HostDoor::send_at_once(const std::string& route, Frames& frames) {
    if (route == launcher_route) return launcher_ && launcher_->send(frames);
    if (!port_) return false;
    frames.emplace(frames.begin(), route);
    const auto result = port_->send(frames);
    if (result == SendResult::sent) return true;
    frames.erase(frames.begin());
    gone_ = result == SendResult::peer_is_gone;
    return false;
}

bool HostDoor::send(Frames& frames) {
    const auto route = text_of(frames.front());
    const auto now = std::chrono::steady_clock::now();
    frames.erase(frames.begin());
    gone_ = false;
    auto& to = line_to(route, now).line;
    const bool sent = to.send(frames, now, [&](Frames& packet) { return send_at_once(route, packet); });
    if (gone_) lines_.erase(route);
    if (!sent && !gone_ && !frames.empty()) to.put(std::move(frames));
    return sent;
}

// Who dials anew is asked anew, too.
void HostDoor::begin_anew(const std::string& route) {
    const auto found = lines_.find(route);
    if (found == lines_.end()) return;
    found->second.line.drop_waiting();
    found->second.line.restart();
}

void HostDoor::go_on(Time now) {
    for (auto one = lines_.begin(); one != lines_.end();) {
        const auto& route = one->first;
        auto& line = one->second.line;
        gone_ = false;
        if (line.waiting()) line.go_on(now, [&](Frames& packet) { return send_at_once(route, packet); });
        one = gone_ ? lines_.erase(one) : std::next(one);
    }
}

bool HostDoor::waiting() const {
    return std::any_of(lines_.begin(), lines_.end(), [](const auto& one) { return one.second.line.waiting(); });
}

void HostDoor::drop_waiting() {
    for (auto& [route, to] : lines_) to.line.drop_waiting();
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
        tell_silence();
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

// Once for each reason that its name may be.
void HostDoor::tell_silence() {
    const auto why = launcher_ ? launcher_->trouble() : std::string();
    if (why.empty() || why == known_.silence) return;
    known_.silence = why;
    options_.log({LogLevel::warning,
                  "the launcher at " + options_.join + " does not answer: " + why + "; this host goes on dialling"});
}

void HostDoor::count(const std::string& route, std::uint64_t run) {
    run_ = run;
    if (route == counted_) return;
    counted_ = route;
    tally_ = {tally_.line + 1, 0, 0, {}};
    auto& line = line_to(route, std::chrono::steady_clock::now());
    line.told_before = line.line.counted();
}

const HostDoor::Tally& HostDoor::tally() {
    const auto found = lines_.find(counted_);
    if (found != lines_.end()) tally_.told = found->second.line.counted() - found->second.told_before;
    return tally_;
}

void HostDoor::let_in() {
    if (port_) port_->let_in();
}

void HostDoor::watch(Poll& poll, Watched what) const {
    if (port_ && what != Watched::messages) port_->watch_callers(poll);
    if (port_ && what != Watched::callers) port_->watch(poll);
    if (launcher_ && what != Watched::callers) launcher_->watch(poll);
}

}  // namespace lightnet
