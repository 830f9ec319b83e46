#include "transport/launcher/remote_host.hpp"

#include <algorithm>

#include "core/base/build_info.hpp"
#include "core/base/joined.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

constexpr auto call_interval = std::chrono::milliseconds(200);
constexpr auto connect_interval = std::chrono::milliseconds(5);
constexpr auto plan_interval = std::chrono::milliseconds(1);  // for others to come who are in it
constexpr auto busy_interval = std::chrono::seconds(1);
constexpr auto ping_interval = std::chrono::milliseconds(400);
constexpr int abandoned_for_sure = 3;  // handshakes: a line may be cut in the middle of one
constexpr auto renewal_interval = std::chrono::seconds(1);
constexpr auto shortest_lease = std::chrono::milliseconds(1500), longest_lease = std::chrono::milliseconds(10000);
constexpr auto wanted_so = "somebody who watched the run wanted it so";

// Only a handshake that went so far that the two ends differ tells of keys: one that was begun and came to no end may
// have met another program, or a cable that was pulled.
std::string why_no_handshake(Handshake seen, const std::string& name, const std::optional<LineKeys>& keys,
                             bool welcomed) {
    const auto way = "the hosts file says which key it has, as in place \"" + name +
                     "\" { key = \"…\" } (lightnetd --print-key shows it there)";
    const std::string breaks_off = "each connection to it breaks off before a word is said";
    if (seen == Handshake::abandoned && welcomed) return breaks_off + ": its line may be cut";
    if (seen == Handshake::abandoned && !keys) return breaks_off + "; if it has a key, " + way;
    if (!keys) return "it asks for keys: " + way;
    if (seen == Handshake::refused)
        return "it does not know our key (fingerprint " + keys->own.open.fingerprint() +
               "); to be let in, append this line to its list (lightnetd --allow): " + keys->own.open.text() + " NAME";
    return "it has another key than expected (fingerprint " + keys->theirs.fingerprint() +
           "), or none; lightnetd --print-key shows it there";
}

Fields job_for(const std::string& name, const RunOffer& offer, const std::string& plan) {
    return Fields{}
        .set("job", offer.job)
        .set("plan", plan)
        .set("you", name)
        .set("who", offer.who)
        .set("members", offer.members)
        .set("numbers", offer.numbers);
}

// What places did is for the report: one that can't be read is no reason to fail.
Counters counters_of(const Fields& fields, const std::string& name, const ClockAhead& clock, Counters& counters) {
    auto ended = Counters::from(fields.numbers);
    if (fields.text("places").empty()) return ended;
    try {
        ended.places = place_records_from(fields.text("places"));
        for (auto& record : ended.places) record.host = name;
        ended.traces = place_traces_from(fields.text("traces"));
        for (auto& trace : ended.traces)
            trace.host = name, trace.clock_ahead = clock.ahead, trace.clock_error = clock.error;
    } catch (const Error&) {
        ++counters.broken_packets;
    }
    return ended;
}

}  // namespace

RemoteHost::RemoteHost(const RunOffer& offer, Counters& counters, std::string name,
                       std::unique_ptr<HostConnection> connection)
    : HostLink(std::move(name)),
      offer_(offer),
      counters_(counters),
      connection_(std::move(connection)),
      lease_(ping_interval, shortest_lease, longest_lease),
      socket_([this](Frames& frames) { return connection_->send(frames, false); }),
      files_(offer_.blobs) {}

bool RemoteHost::send(Type type, const Fields& fields) {
    // Before it takes part it need not know the number that members of the run are known by.
    const bool member =
        type == Type::begin || type == Type::end || (state_ != State::calling && state_ != State::greeted);
    auto frames = frames_of(packet::pack(type, member ? offer_.run : 0, fields));
    return line_.send(frames, now_, socket_);
}

void RemoteHost::look_at_handshake(Time now) {
    const auto seen = connection_->look_at_handshake();
    if (!seen) return;
    abandoned_ = *seen == Handshake::abandoned ? abandoned_ + 1 : 0;
    if (*seen == Handshake::made) unknown_ = false;
    if (*seen == Handshake::made || *seen == Handshake::unanswered || state_ != State::calling) return;
    if (*seen == Handshake::abandoned && abandoned_ < abandoned_for_sure) return;
    // One that is closed on us by whom we expect by his key is what a wrong key looks like.
    unknown_ = *seen != Handshake::abandoned || (connection_->keys() && !welcomed_);
    reason_ = why_no_handshake(*seen, name_, connection_->keys(), welcomed_);
    if (*seen != Handshake::abandoned) next_renewal_ = now + renewal_interval;  // ZeroMQ tries no more by itself
}

// A connection never gets new keys, so it gets a successor: the host is begun with on that as if it had been lost, and
// goes on with what it has.
// DECISIONS: lines-are-renewed
void RemoteHost::look_at_line(Time now, const ExpectedPlan& plan) {
    if (state_ != State::ready || !connection_->keys()) return line_ends_.reset();
    if (!line_ends_) line_ends_ = now + offer_.line_life;
    if (now < *line_ends_ || connection_->has_old(now)) return;
    connection_->open_next();
    const auto expected = plan();
    if (!expected) return;
    auto frames = frames_of(packet::pack(Type::begin, offer_.run, job_for(name_, offer_, *expected)));
    if (!connection_->send_on_next(frames)) return;
    line_.restart();
    ++renewed_lines_;
    line_ends_ = now + offer_.line_life;
}

void RemoteHost::tick(Time now, const ExpectedPlan& plan) {
    now_ = now;
    if (state_ == State::refused) return;
    connection_->tick(now);
    look_at_handshake(now);
    look_at_line(now, plan);
    if (next_renewal_ && now >= *next_renewal_) {
        next_renewal_.reset();
        connection_->renew();
    }
    if (const auto port = ports_.next_if_silent(now)) connect_anew(port, now);
    const bool calls = state_ == State::calling || ports_.calls();
    if (!calls) heartbeat(now);
    if (now >= next_call_ && calls) {
        const bool connected = send(Type::hello, Fields{}.set("build", build_id()).set("isa", offer_.isa));
        next_call_ = now + (connected ? call_interval : connect_interval);
    } else if (now >= next_call_ && state_ == State::greeted) {
        const auto expected = plan();
        next_call_ = now + (expected ? std::chrono::milliseconds(busy_interval) : plan_interval);
        if (expected && !line_.waiting()) send(Type::begin, job_for(name_, offer_, *expected));
    }
    line_.go_on(now, socket_);
    if (files_.stuck(now)) return lose(now, "it takes no files");
    counters_.file_bytes +=
        files_.send(offer_.run, now, [this](Frames& frames) { return connection_->send(frames, true); });
}

void RemoteHost::heartbeat(Time now) {
    const auto busy_for = std::max(line_.expected(), files_.expected());
    if (lease_.is_over(now, busy_for)) return lose(now, "it does not answer");
    if (now < next_ping_) return;
    next_ping_ = now + ping_interval;
    // Figures are worth less than what they cost, so every other heartbeat does without.
    ask_figures_ = watched_ && !ask_figures_;
    auto fields = Fields{}.set("sent", line_.counted()).set("asked_at", steady_nanoseconds());
    if (ask_figures_) fields.set("watch", 1);
    send(Type::ping, fields);
}

bool RemoteHost::take_out(const std::string& why) {
    if (state_ != State::calling) send_end();
    state_ = State::refused;
    reason_ = why;
    files_.clear();
    offer_.holders->lose(name_);
    return true;
}

bool RemoteHost::drain() {
    if (state_ == State::refused) return false;
    if (!takes_part()) return take_out(wanted_so);
    drained_ = send(Type::leaving, {});
    return drained_;
}

void RemoteHost::lose(Time now, const std::string& why) {
    if (drained_) return void(take_out(wanted_so));
    state_ = State::calling;
    reason_ = why;
    files_.restart();
    offer_.holders->lose(name_);
    connect_anew({}, now);
    ports_.call(now);
}

// `port`: another one, of a daemon that serves several runs; none: as before.
void RemoteHost::connect_anew(std::optional<std::uint16_t> port, Time now) {
    port ? connection_->call_at(*port) : connection_->renew();
    line_.drop_waiting();
    line_.restart();
    counts_.restart(line_.counted());
    next_call_ = now;
}

// Who comes back after a loss was not late.
void RemoteHost::hear(Time now) {
    if (state_ == State::calling)
        lease_.begin(now);
    else
        lease_.heard(now);
}

// What is no message, or a part of one, shows all the same that the host is alive.
std::optional<Frames> RemoteHost::next_message(Time now) {
    now_ = now;
    while (auto frames = connection_->receive()) {
        if (auto message = line_.take(std::move(*frames), now, socket_)) return message;
        hear(now);
        ++carried_;
    }
    return std::nullopt;
}

bool RemoteHost::receive(Time now, const Handlers& handlers) {
    auto frames = next_message(now);
    if (!frames) return false;
    if (is_empty(*frames)) {
        if (state_ != State::calling && state_ != State::refused) lose(now, "its connection was cut");
        return true;
    }
    if (frames->size() == 3) {
        hear(now);
        const auto passing = packet::peek_header(bytes_of((*frames)[1]));
        if (passing && packet::is_counted(passing->type)) counts_.received();
        handlers.relay(*this, *frames);
        return true;
    }
    if (frames->size() != 2) {
        damaged(now, {});
        return true;
    }
    const auto header_bytes = bytes_of((*frames)[0]), body = bytes_of((*frames)[1]);
    const auto header = packet::read_header(header_bytes, body);
    if (!header) {
        damaged(now, header_bytes);
        return true;
    }
    hear(now);
    if (packet::is_counted(header->type)) counts_.received();
    if (header->type < Type::hello) {
        counters_.bytes += header_bytes.size() + body.size();
        if (auto message = packet::unpack(header_bytes, body)) handlers.work(std::move(*message));
    } else if (const auto fields = packet::unpack_fields(body)) {
        control(header->type, *fields, now);
    }
    return true;
}

void RemoteHost::damaged(Time now, std::span<const std::byte> header) {
    ++counters_.broken_packets;
    const auto theirs = packet::claimed_version(header);
    if (state_ == State::calling && theirs && *theirs != packet::version) {
        state_ = State::refused;
        reason_ =
            "it speaks protocol version " + std::to_string(*theirs) + ", we speak " + std::to_string(packet::version);
    } else if (state_ != State::calling && state_ != State::refused) {
        lose(now, "what it sent was damaged");
    }
}

void RemoteHost::control(Type type, const Fields& fields, Time now) {
    switch (type) {
        case Type::welcome:
            if (state_ == State::calling || ports_.calls()) welcome(fields);
            next_call_ = now;
            return;
        case Type::refuse:
            reason_ = fields.text("text");
            if (!fields.number("busy")) state_ = State::refused;
            if (const auto port = ports_.next_after_refusal(fields.text("ports"), now)) connect_anew(port, now);
            return;
        case Type::need:
            if (state_ != State::greeted) return;
            reason_.clear();
            ports_.taken();
            files_.lacks_offered(fields.text("hashes"));
            state_ = files_.waiting() ? State::sending : State::building;
            return;
        case Type::blob_taken:
            files_.piece_taken(now);
            ++carried_;
            if (state_ == State::sending && !files_.waiting() && !files_.under_way()) state_ = State::building;
            return;
        case Type::lacks:
            if (const auto hash = hash_from_hex(fields.text("hash"))) files_.lacks(*hash);
            return;
        case Type::here:
            if (const auto hash = hash_from_hex(fields.text("hash"))) {
                files_.has(*hash);
                if (takes_part()) offer_.holders->has(name_, *hash);
            }
            return;
        case Type::ready:
            if (state_ == State::building || state_ == State::sending) state_ = State::ready;
            return;
        case Type::broken:
            broken_ = true;
            reason_ = fields.text("text");
            state_ = State::refused;
            return;
        case Type::fault:
            failures_.push_back(
                {fields.text("text") + " (" + name_ + " asked)", fields.text("host"), fields.number("lie") != 0});
            return;
        case Type::pong:
            if (state_ == State::calling || state_ == State::refused) return;
            counts_.arrived(fields.number("sent"));
            news_.clock.compare(fields.number("asked_at"), fields.number("clock"), steady_nanoseconds());
            if (fields.number("process") != process_)
                lose(now, "it was started anew");
            else if (state_ != State::greeted && fields.number("run") != offer_.run)
                lose(now, "it gave the run up");
            else if (fields.number("run") == offer_.run && counts_.lacks_something(fields, connection_->has_old(now)))
                lose(now, "a message to or from it was lost");
            peak_memory_ = std::max(peak_memory_, fields.number("peak_memory"));
            news_.take(fields);
            return;
        case Type::leaving:
            if (state_ == State::ready) {
                state_ = State::leaving;
                reason_ = fields.text("text");
            } else if (state_ != State::leaving)
                lose(now, "it was told to stop");
            return;
        case Type::ended: {
            peak_memory_ = std::max(peak_memory_, fields.number("peak_memory"));
            ended_ = counters_of(fields, name_, news_.clock, counters_);
            if (state_ == State::leaving && drained_)
                take_out(wanted_so);
            else if (state_ == State::leaving) {
                send_end();
                lose(now, "it was told to stop");
            }
            return;
        }
        default:
            return;
    }
}

void RemoteHost::welcome(const Fields& fields) {
    if (fields.number("fingerprint") != offer_.fingerprint) {
        state_ = State::refused;
        reason_ = "it computes differently (its rays or its mathematical library give other last bits)";
        return;
    }
    unknown_ = false, welcomed_ = true;
    reason_.clear();
    ports_.answered();
    places_ = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fields.number("places"), 1, 1024));
    process_ = fields.number("process");
    machine_ = machine_from(fields);
    state_ = State::greeted;
}

bool RemoteHost::send(Message& message, std::uint32_t place) {
    auto frames = frames_of(packet::pack(message, place));
    const std::size_t size = frames[0].size() + frames[1].size();
    if (!forward(frames)) return false;
    counters_.bytes += size;
    return true;
}

bool RemoteHost::forward(Frames& frames) {
    const bool sent = line_.send(frames, now_, socket_);
    if (!sent) counters_.refused_sends += may_be_full(counts_.under_way(line_.counted()));
    return sent;
}

void RemoteHost::request_resend() {
    auto frames = empty_message();
    forward(frames);
}

// Who is not told now is told when it is begun with.
void RemoteHost::tell_members() {
    const bool begun = state_ != State::calling && state_ != State::greeted && state_ != State::refused;
    if (begun) send(Type::members, Fields{}.set("members", offer_.members).set("numbers", offer_.numbers));
}

bool RemoteHost::bring(const Hash& name, const Bytes& bytes) {
    const bool is_new = files_.bring(name, bytes);
    if (is_new) {
        auto fields = Fields{}.set("hash", to_hex(name)).set("size", bytes->size());
        fields.set("holders", joined(offer_.holders->of(name, name_), "\n"));
        if (!send(Type::expect, fields)) files_.forget(name);
    }
    return !is_new && files_.is_there(name);
}

void RemoteHost::use(const WrittenPlan& plan) { send(Type::plan, Fields{}.set("plan", plan.text)); }

// What still waits for the line is not wanted any more.
void RemoteHost::send_end() {
    line_.drop_waiting();
    send(Type::end, {});
}

}  // namespace lightnet
