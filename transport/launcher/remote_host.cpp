#include "transport/launcher/remote_host.hpp"

#include <algorithm>

#include "core/base/build_info.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

constexpr auto call_interval = std::chrono::milliseconds(200);
constexpr auto connect_interval = std::chrono::milliseconds(5);
constexpr auto busy_interval = std::chrono::seconds(1);
constexpr auto ping_interval = std::chrono::milliseconds(400);
constexpr auto lease = std::chrono::milliseconds(1500);
constexpr auto longest_piece = std::chrono::seconds(15);  // for a piece of a file to be taken
constexpr std::size_t piece_size = 256 << 10;
constexpr std::size_t pieces_under_way = 16;

}  // namespace

RemoteHost::RemoteHost(const RunOffer& offer, Counters& counters, std::string name,
                       std::unique_ptr<HostConnection> connection)
    : HostLink(std::move(name)), offer_(offer), counters_(counters), connection_(std::move(connection)) {}

bool RemoteHost::send(Type type, const Fields& fields) {
    // Before it takes part it need not know the number that members of the run are known by.
    const bool member =
        type == Type::begin || type == Type::end || (state_ != State::calling && state_ != State::greeted);
    auto frames = frames_of(packet::pack(type, member ? offer_.run : 0, fields));
    const bool sent = connection_->send(frames, false);
    if (sent && packet::is_counted(type)) ++sent_;
    return sent;
}

void RemoteHost::tick(Time now, const ExpectedPlan& plan) {
    if (state_ == State::refused) return;
    if (state_ != State::calling) heartbeat(now);
    if (now >= next_call_ && state_ == State::calling) {
        const bool connected = send(Type::hello, Fields{}.set("build", build_id()).set("isa", offer_.isa));
        next_call_ = now + (connected ? call_interval : connect_interval);
    } else if (now >= next_call_ && state_ == State::greeted) {
        const auto expected = plan();
        next_call_ = now + (expected ? std::chrono::milliseconds(busy_interval) : connect_interval);
        if (expected)
            send(Type::begin,
                 Fields{}.set("job", offer_.job).set("plan", *expected).set("you", name_).set("who", offer_.who));
    }
    if (pieces_out_ > 0 && now - piece_taken_ > longest_piece) return lose(now, "it takes no files");
    if (!pieces_.empty()) send_blobs(now);
}

void RemoteHost::heartbeat(Time now) {
    if (now - heard_ > lease) return lose(now, "it does not answer");
    if (now < next_ping_) return;
    next_ping_ = now + ping_interval;
    send(Type::ping, Fields{}.set("sent", sent_));
}

// A flipped bit can make a message vanish without a trace.
bool RemoteHost::lacks_something(const Fields& pong) {
    const Between now{pong.number("line"), pong.number("taken") - pong.number("sent"), pong.number("told") - received_};
    if (!between_ || between_->line != now.line) between_ = now;
    return *between_ != now;
}

bool RemoteHost::take_out(const std::string& why) {
    if (state_ != State::calling) send_end();
    state_ = State::refused;
    reason_ = why;
    pieces_.clear();
    brought_.clear();
    return true;
}

void RemoteHost::lose(Time now, const std::string& why) {
    state_ = State::calling;
    reason_ = why;
    next_call_ = now;
    pieces_.clear();
    pieces_out_ = 0;
    brought_.clear();
    between_.reset();
    arrived_ = sent_;
    connection_->renew();
}

bool RemoteHost::receive(Time now, const Handlers& handlers) {
    auto frames = connection_->receive();
    if (!frames) return false;
    if (is_empty(*frames)) {
        if (state_ != State::calling && state_ != State::refused) lose(now, "its connection was cut");
        return true;
    }
    if (frames->size() == 3) {
        heard_ = now;
        const auto passing = packet::peek_header(bytes_of((*frames)[1]));
        received_ += passing && packet::is_counted(passing->type);
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
    heard_ = now;
    if (packet::is_counted(header->type)) ++received_;
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
            if (state_ == State::calling) welcome(fields);
            next_call_ = now;
            return;
        case Type::refuse:
            reason_ = fields.text("text");
            if (!fields.number("busy")) state_ = State::refused;
            return;
        case Type::need:
            if (state_ != State::greeted) return;
            reason_.clear();
            queue_blobs(fields.text("hashes"));
            state_ = pieces_.empty() ? State::building : State::sending;
            return;
        case Type::blob_taken:
            if (pieces_out_ > 0) --pieces_out_;
            piece_taken_ = now;
            if (state_ == State::sending && pieces_.empty() && pieces_out_ == 0) state_ = State::building;
            return;
        case Type::lacks:
            if (const auto hash = hash_from_hex(fields.text("hash")); hash && brought_.contains(*hash))
                queue_blob(*hash);
            return;
        case Type::here:
            if (const auto hash = hash_from_hex(fields.text("hash")); hash && brought_.contains(*hash))
                brought_[*hash] = {nullptr, true};
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
            failures_.push_back({fields.text("text") + " (" + name_ + " had asked it)", fields.text("host")});
            return;
        case Type::pong:
            if (state_ == State::calling || state_ == State::refused) return;
            arrived_ = fields.number("sent");
            if (fields.number("process") != process_)
                lose(now, "it was started anew");
            else if (state_ != State::greeted && fields.number("run") != offer_.run)
                lose(now, "it gave the run up");
            else if (fields.number("run") == offer_.run && lacks_something(fields))
                lose(now, "a message to or from it was lost");
            progress_ = fields.number("progress");
            return;
        case Type::leaving:
            if (state_ == State::ready)
                state_ = State::leaving;
            else if (state_ != State::leaving)
                lose(now, "it was told to stop");
            return;
        case Type::ended: {
            ended_ = Counters::from(fields.numbers);
            if (state_ == State::leaving) {
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
    places_ = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fields.number("places"), 1, 1024));
    process_ = fields.number("process");
    machine_ = machine_from(fields);
    state_ = State::greeted;
}

void RemoteHost::queue_blobs(const std::string& hashes) {
    constexpr std::size_t digits = 64;
    for (std::size_t at = 0; at + digits <= hashes.size(); at += digits) {
        const auto hash = hash_from_hex(std::string_view(hashes).substr(at, digits));
        if (hash && offer_.blobs.contains(*hash)) queue_blob(*hash);
    }
}

Bytes RemoteHost::blob(const Hash& hash) const {
    const auto offered = offer_.blobs.find(hash);
    return offered != offer_.blobs.end() ? offered->second : brought_.at(hash).bytes;
}

void RemoteHost::queue_blob(const Hash& hash) {
    const auto bytes = blob(hash);
    if (!bytes) return;
    std::uint64_t offset = 0;
    do {
        pieces_.push_back({hash, offset});
        offset += piece_size;
    } while (offset < bytes->size());
}

bool RemoteHost::bring(const Hash& name, const Bytes& bytes) {
    const auto [brought, first] = brought_.try_emplace(name, Brought{bytes, false});
    if (first && !send(Type::expect, Fields{}.set("hash", to_hex(name)).set("size", bytes->size())))
        brought_.erase(brought);
    return !first && brought->second.here;
}

void RemoteHost::send_blobs(Time now) {
    while (!pieces_.empty() && pieces_out_ < pieces_under_way) {
        const auto& [hash, offset] = pieces_.front();
        const auto whole = blob(hash);
        if (!whole) {  // it is there already
            pieces_.pop_front();
            continue;
        }
        const auto bytes = std::span(*whole).subspan(offset, std::min<std::size_t>(piece_size, whole->size() - offset));
        auto frames = frames_of(packet::pack(offer_.run, {hash, offset, bytes}));
        if (!connection_->send(frames, true)) return;
        counters_.file_bytes += bytes.size();
        if (pieces_out_++ == 0) piece_taken_ = now;
        pieces_.pop_front();
    }
}

bool RemoteHost::send(Message& message, std::uint32_t place) {
    auto frames = frames_of(packet::pack(message, place));
    const std::size_t size = frames[0].size() + frames[1].size();
    if (!connection_->send(frames, false)) {
        counters_.refused_sends += may_be_full(sent_ - arrived_);
        return false;
    }
    counters_.bytes += size;
    ++sent_;
    return true;
}

bool RemoteHost::forward(Frames& frames) {
    const bool work = frames.size() == 3;  // or that something is to be sent again
    if (connection_->send(frames, false)) {
        sent_ += work;
        return true;
    }
    counters_.refused_sends += may_be_full(sent_ - arrived_);
    return false;
}

void RemoteHost::request_resend() {
    auto frames = empty_message();
    forward(frames);
}

void RemoteHost::use(const WrittenPlan& plan) { send(Type::plan, Fields{}.set("plan", plan.text)); }

void RemoteHost::send_end() { send(Type::end, {}); }

}  // namespace lightnet
