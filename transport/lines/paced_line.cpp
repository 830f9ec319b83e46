#include "transport/lines/paced_line.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lightnet {
namespace {

using packet::Header;
using packet::Type;
using Length = std::uint32_t;  // of a frame, before it

std::size_t size_of(const Frames& frames) {
    std::size_t size = 0;
    for (const auto& frame : frames) size += sizeof(Length) + frame.size();
    return size;
}

std::optional<Header> header_of(const Frames& frames) {
    return frames.size() < 2 ? std::nullopt : packet::peek_header(bytes_of(frames[frames.size() - 2]));
}

bool waits_its_turn(const Frames& frames) {
    const auto header = header_of(frames);
    return header && packet::waits_its_turn(header->type);
}

bool is_counted(const Frames& frames) {
    const auto header = header_of(frames);
    return header && packet::is_counted(header->type);
}

// [first, first + size) of all frames, each behind its length.
std::vector<std::byte> slice(const Frames& frames, std::size_t first, std::size_t size) {
    std::vector<std::byte> out;
    out.reserve(size);
    const auto add = [&](std::span<const std::byte> bytes) {
        const auto skipped = std::min(first, bytes.size());
        first -= skipped;
        const auto taken = bytes.subspan(skipped, std::min(bytes.size() - skipped, size - out.size()));
        out.insert(out.end(), taken.begin(), taken.end());
    };
    for (const auto& frame : frames) {
        const auto length = static_cast<Length>(frame.size());
        add(std::as_bytes(std::span(&length, 1)));
        add(bytes_of(frame));
    }
    return out;
}

std::optional<Frames> frames_in(std::span<const std::byte> bytes) {
    constexpr std::size_t most_frames = 4;
    Frames frames;
    while (!bytes.empty() && frames.size() < most_frames) {
        Length length = 0;
        if (bytes.size() < sizeof length) return std::nullopt;
        std::memcpy(&length, bytes.data(), sizeof length);
        bytes = bytes.subspan(sizeof length);
        if (length > bytes.size()) return std::nullopt;
        frames.emplace_back(std::string_view(reinterpret_cast<const char*>(bytes.data()), length));
        bytes = bytes.subspan(length);
    }
    if (!bytes.empty()) return std::nullopt;
    return frames;
}

}  // namespace

bool PacedLine::send(Frames& frames, Time now, const Send& socket) {
    if (unpaced_ || !waits_its_turn(frames)) return socket(frames);
    const auto size = size_of(frames);
    if (waiting_.empty() && size <= pace_.piece() && pace_.may_send(size)) {
        if (!send_whole(frames, now, socket)) return false;
        ask_how_far(now, false, socket);
        return true;
    }
    put(std::move(frames));
    go_on(now, socket);
    return true;
}

void PacedLine::put(Frames frames) {
    if (waits_already(frames)) return;
    const auto size = static_cast<std::uint32_t>(size_of(frames));
    waiting_.push_back({std::move(frames), size});
}

// Who asks again, as no answer has come, need not be heard twice.
bool PacedLine::waits_already(const Frames& ask) const {
    const auto header = waiting_.empty() ? std::nullopt : header_of(ask);
    if (!header || !packet::is_ask(header->type)) return false;
    const auto bytes = bytes_of(ask[ask.size() - 2]);
    return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
        return one.frames.size() == ask.size() && std::ranges::equal(bytes_of(one.frames[ask.size() - 2]), bytes);
    });
}

bool PacedLine::send_whole(Frames& frames, Time now, const Send& socket) {
    const auto size = size_of(frames);
    const bool counts = is_counted(frames);
    refused_ = !socket(frames);
    if (refused_) return false;
    counted_ += counts;
    pace_.sent(size, now);
    return true;
}

bool PacedLine::send_part(Waiting& message, std::size_t size, Time now, const Send& socket) {
    const auto header = header_of(message.frames);
    const auto bytes = slice(message.frames, message.offset, size);
    auto part = frames_of(packet::pack(header ? header->run : 0, {message.offset, message.size, bytes}));
    refused_ = !socket(part);
    if (refused_) return false;
    pace_.sent(size + packet::header_size, now);
    message.offset += static_cast<std::uint32_t>(size);
    return true;
}

void PacedLine::go_on(Time now, const Send& socket) {
    while (!waiting_.empty()) {
        auto& next = waiting_.front();
        const auto size = std::min<std::size_t>(next.size - next.offset, pace_.piece());
        if (!pace_.may_send(size)) break;
        const bool whole = size == next.size;
        if (!(whole ? send_whole(next.frames, now, socket) : send_part(next, size, now, socket))) return;
        if (whole || next.offset == next.size) {
            if (!whole) counted_ += is_counted(next.frames);
            waiting_.pop_front();
        }
        ask_how_far(now, false, socket);
    }
    ask_how_far(now, !waiting_.empty(), socket);
}

// A mark that the socket refuses is wanted again.
void PacedLine::ask_how_far(Time now, bool blocked, const Send& socket) {
    if (!pace_.wants_mark(blocked, now)) return;
    auto frames = frames_of(packet::pack(Type::mark, pace_.next_mark()));
    refused_ = !socket(frames);
    if (!refused_) pace_.mark(now);
}

std::optional<Frames> PacedLine::take(Frames frames, Time now, const Send& socket) {
    const auto peeked = frames.size() == 2 ? header_of(frames) : std::nullopt;
    if (!peeked || peeked->type < Type::part) return frames;
    const auto body = bytes_of(frames[1]);
    const auto header = packet::read_header(bytes_of(frames[0]), body);
    if (!header) return frames;  // damaged: whose it is shall see
    if (header->type == Type::part) return add(*header, body);
    if (header->type == Type::unpaced) {
        unpaced_ = true;
        return std::nullopt;
    }
    if (header->type == Type::mark) {
        auto answer = frames_of(packet::pack(Type::marked, header->bundle));
        socket(answer);
    } else {
        pace_.taken(header->bundle, now);
        go_on(now, socket);
    }
    return std::nullopt;
}

// Parts come in their order, or a connection was cut between them: then all is sent again.
std::optional<Frames> PacedLine::add(const Header& header, std::span<const std::byte> body) {
    const auto part = packet::part_of(header, body);
    if (part && part->offset == 0) arriving_.clear();
    if (!part || part->offset != arriving_.size()) return std::nullopt;
    arriving_.insert(arriving_.end(), part->bytes.begin(), part->bytes.end());
    if (arriving_.size() < part->whole) return std::nullopt;
    const auto bytes = std::exchange(arriving_, {});
    return frames_in(bytes);
}

void PacedLine::restart() {
    pace_.restart();
    arriving_ = {};
    if (!waiting_.empty()) waiting_.front().offset = 0;
}

}  // namespace lightnet
