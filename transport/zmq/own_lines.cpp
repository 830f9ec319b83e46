#include "transport/zmq/own_lines.hpp"

#include <algorithm>
#include <chrono>

namespace lightnet {

OwnLines::OwnLines(const SocketContext& context, std::shared_ptr<const LineBook> book)
    : context_(context), book_(std::move(book)) {}

bool OwnLines::send(const std::string& host, Frames& packet, std::size_t bytes) {
    const auto found = lines_.find(host);
    if (found == lines_.end()) return false;
    auto& line = found->second;
    const bool has_room = line.under_way == 0 || line.under_way + bytes <= line.entry.room;
    if (!line.greeted || !line.wanted || !has_room || !line.source.socket.send(packet)) return false;
    line.under_way += bytes;
    return true;
}

void OwnLines::settled(const std::string& host, std::size_t bytes) {
    const auto found = lines_.find(host);
    if (found != lines_.end()) found->second.under_way -= std::min(bytes, found->second.under_way);
}

std::optional<std::pair<std::string, Frames>> OwnLines::receive() {
    for (auto& [host, line] : lines_)
        while (auto frames = line.source.receive())
            if (auto packet = take(host, line, std::move(*frames))) return std::pair(host, std::move(*packet));
    return std::nullopt;
}

std::optional<Frames> OwnLines::take(const std::string& host, Line& line, Frames frames) {
    if (!is_empty(frames))
        return line.paced.take(std::move(frames), std::chrono::steady_clock::now(),
                               [&](Frames& answer) { return line.source.socket.send(answer); });
    greeted(host, line);
    return std::nullopt;
}

// A greeting is the first word on each connection: what was under way on the one before may be lost.
void OwnLines::greeted(const std::string& host, Line& line) {
    line.paced.restart();
    line.under_way = 0;
    if (std::exchange(line.greeted, true)) cut_.push_back(host);
    auto wish = frames_of(packet::pack(packet::Type::unpaced, std::uint64_t{0}));
    line.source.socket.send(wish);
}

void OwnLines::look_into_book(const std::function<bool(const std::string& host)>& waits_for) {
    if (!book_ || book_->edition() == edition_) return;
    edition_ = book_->edition();
    const auto entries = book_->entries();
    for (auto& [host, line] : lines_) line.wanted = entries.contains(host);
    for (const auto& [host, entry] : entries) use(host, entry);
    std::erase_if(lines_, [&](const auto& one) { return !one.second.wanted && !waits_for(one.first); });
}

// A line that is renewed takes with it what is under way on it.
// DECISIONS: lines-are-renewed
void OwnLines::use(const std::string& host, const LineBook::Entry& entry) {
    const auto found = lines_.find(host);
    if (found != lines_.end() && found->second.entry.same_line(entry)) {
        found->second.entry.room = entry.room;
        return;
    }
    if (found != lines_.end()) {
        lines_.erase(found);  // first: there may be no descriptors for both
        cut_.push_back(host);
    }
    try {
        lines_.emplace(host, Line{{asking_socket(context_, entry.endpoint, entry.keys)}, entry});
    } catch (const SocketError&) {  // out of descriptors, say: the host has a line already
    }
}

std::vector<Source*> OwnLines::sources() {
    std::vector<Source*> sources;
    for (auto& [host, line] : lines_) sources.push_back(&line.source);
    return sources;
}

}  // namespace lightnet
