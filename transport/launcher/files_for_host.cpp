#include "transport/launcher/files_for_host.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include "transport/wire/packet.hpp"

namespace lightnet {
namespace {

constexpr std::size_t largest_piece = 256 << 10;
constexpr std::size_t most_under_way = 4 << 20;
constexpr auto longest_piece = std::chrono::seconds(15);  // for a piece of a file to be taken

}  // namespace

FilesForHost::FilesForHost(const std::map<Hash, Bytes>& offered)
    : offered_(offered), pace_(most_under_way, largest_piece) {}

void FilesForHost::lacks_offered(const std::string& hashes) {
    constexpr std::size_t digits = 64;
    for (std::size_t at = 0; at + digits <= hashes.size(); at += digits) {
        const auto hash = hash_from_hex(std::string_view(hashes).substr(at, digits));
        if (hash && offered_.contains(*hash)) queue(*hash);
    }
}

bool FilesForHost::bring(const Hash& name, const Bytes& bytes) {
    return brought_.try_emplace(name, Brought{bytes, false}).second;
}

void FilesForHost::lacks(const Hash& name) {
    if (brought_.contains(name)) queue(name);
}

void FilesForHost::has(const Hash& name) {
    if (const auto found = brought_.find(name); found != brought_.end()) found->second = {nullptr, true};
}

Bytes FilesForHost::bytes_of(const Hash& hash) const {
    const auto offered = offered_.find(hash);
    return offered != offered_.end() ? offered->second : brought_.at(hash).bytes;
}

void FilesForHost::queue(const Hash& hash) {
    if (bytes_of(hash)) pieces_.push_back({hash, 0});
}

bool FilesForHost::stuck(Time now) const { return under_way() && now - taken_ > longest_piece; }

std::uint64_t FilesForHost::send(std::uint64_t run, Time now, const Send& send) {
    std::uint64_t sent = 0;
    while (!pieces_.empty()) {
        auto& [hash, offset] = pieces_.front();
        const auto whole = bytes_of(hash);
        if (!whole) {  // it is there already
            pieces_.pop_front();
            continue;
        }
        const auto bytes =
            std::span(*whole).subspan(offset, std::min<std::size_t>(pace_.piece(), whole->size() - offset));
        if (!pace_.may_send(bytes.size())) break;
        auto frames = frames_of(packet::pack(run, {hash, offset, bytes}));
        if (!send(frames)) break;
        sent += bytes.size();
        if (!under_way()) taken_ = now;
        pace_.sent_piece(bytes.size() + packet::header_size, now);
        offset += bytes.size();
        if (offset == whole->size()) pieces_.pop_front();
    }
    return sent;
}

void FilesForHost::piece_taken(Time now) {
    pace_.piece_taken(now);
    taken_ = now;
}

void FilesForHost::clear() {
    pieces_.clear();
    brought_.clear();
}

void FilesForHost::restart() {
    clear();
    pace_.restart();
}

}  // namespace lightnet
