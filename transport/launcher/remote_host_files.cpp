// Files of the job for a host, and what others have prepared: in pieces, as many under way as its line takes.
#include <algorithm>

#include "transport/launcher/remote_host.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

constexpr std::size_t largest_piece = 256 << 10;
constexpr std::size_t most_under_way = 4 << 20;

}  // namespace

LinePace RemoteHost::pace_of_files() { return LinePace(most_under_way, largest_piece); }

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
    if (blob(hash)) pieces_.push_back({hash, 0});
}

bool RemoteHost::bring(const Hash& name, const Bytes& bytes) {
    const auto [brought, first] = brought_.try_emplace(name, Brought{bytes, false});
    if (first && !send(Type::expect, Fields{}.set("hash", to_hex(name)).set("size", bytes->size())))
        brought_.erase(brought);
    return !first && brought->second.here;
}

void RemoteHost::send_blobs(Time now) {
    while (!pieces_.empty()) {
        auto& [hash, offset] = pieces_.front();
        const auto whole = blob(hash);
        if (!whole) {  // it is there already
            pieces_.pop_front();
            continue;
        }
        const auto bytes =
            std::span(*whole).subspan(offset, std::min<std::size_t>(files_.piece(), whole->size() - offset));
        if (!files_.may_send(bytes.size())) return;
        auto frames = frames_of(packet::pack(offer_.run, {hash, offset, bytes}));
        if (!connection_->send(frames, true)) return;
        counters_.file_bytes += bytes.size();
        if (!pieces_out()) piece_taken_ = now;
        files_.sent_piece(bytes.size() + packet::header_size, now);
        offset += bytes.size();
        if (offset == whole->size()) pieces_.pop_front();
    }
}

}  // namespace lightnet
