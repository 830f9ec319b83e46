// Bytes of a known name and size that come in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/hash.hpp"
#include "core/readers/files/files.hpp"

namespace lightnet {

/// How far they are. What is `damaged` is as long as it should be, and not what its name says; what is `too_long` has
/// had a piece that ends behind its end.
enum class Arrival { under_way, whole, damaged, too_long };

/// Which part of each piece is new, and whether all of them together are what they are named. Pieces count from the
/// beginning: one that is there comes to nothing, and so does one before which another is missing; where it begins
/// anew, perhaps cut in other places, it goes on from where it was. Where bytes are put is the caller's. One thread's.
class ArrivingBytes {
public:
    /// `size`: bytes.
    ArrivingBytes(const Hash& name, std::uint64_t size) : name_(name), size_(size) {}
    std::uint64_t size() const { return size_; }
    /// So many bytes from the beginning have come.
    std::uint64_t here() const { return here_; }
    /// The part of a piece, `offset` bytes from the beginning, that was awaited next. See `state()` afterwards.
    std::span<const std::byte> take(std::uint64_t offset, std::span<const std::byte> piece);
    Arrival state() const { return state_; }

private:
    Hash name_;
    std::uint64_t size_, here_ = 0;
    std::optional<Hasher> hasher_{std::in_place};  // until the end
    Arrival state_ = Arrival::under_way;
};

/// A result of preparing on its way to a host, in its memory; from the launcher or from another host. No more room is
/// taken for it than what is there, and 64 MB at first. One thread's.
class ArrivingResult {
public:
    ArrivingResult(const Hash& name, std::uint64_t size);
    std::uint64_t size() const { return pieces_.size(); }
    std::uint64_t here() const { return pieces_.here(); }
    /// As ArrivingBytes does.
    Arrival take(std::uint64_t offset, std::span<const std::byte> piece);
    /// When it is whole. Once.
    Bytes bytes() { return std::move(bytes_); }

private:
    ArrivingBytes pieces_;
    std::shared_ptr<std::vector<std::byte>> bytes_ = std::make_shared<std::vector<std::byte>>();
};

}  // namespace lightnet
