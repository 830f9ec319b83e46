// How a host gets the files of the job, and what others have prepared: in pieces, a few under way at a time.
#include <algorithm>

#include "transport/launcher/remote_host.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

constexpr std::size_t piece_size = 256 << 10;
constexpr std::size_t pieces_under_way = 16;

}  // namespace

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

}  // namespace lightnet
