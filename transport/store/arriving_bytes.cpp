#include "transport/store/arriving_bytes.hpp"

#include <algorithm>
#include <utility>

namespace lightnet {

std::span<const std::byte> ArrivingBytes::take(std::uint64_t offset, std::span<const std::byte> piece) {
    if (state_ != Arrival::under_way || offset > here_) return {};
    if (offset > size_ || piece.size() > size_ - offset) {
        state_ = Arrival::too_long;
        return {};
    }
    const auto fresh = piece.subspan(std::min<std::uint64_t>(here_ - offset, piece.size()));
    hasher_->add(fresh);
    here_ += fresh.size();
    if (here_ == size_) {
        state_ = hasher_->finish() == name_ ? Arrival::whole : Arrival::damaged;
        hasher_.reset();
    }
    return fresh;
}

ArrivingResult::ArrivingResult(const Hash& name, std::uint64_t size) : pieces_(name, size) {
    constexpr std::uint64_t believed = std::uint64_t{64} << 20;
    bytes_->reserve(std::min(size, believed));
}

Arrival ArrivingResult::take(std::uint64_t offset, std::span<const std::byte> piece) {
    const auto fresh = pieces_.take(offset, piece);
    bytes_->insert(bytes_->end(), fresh.begin(), fresh.end());
    return pieces_.state();
}

}  // namespace lightnet
