// Results of all shards of a Services::map().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/bytes.hpp"

namespace lightnet {

/// Puts the results of shards 0, 1, … behind each other as they come. Layout: the results, then the size of each in
/// bytes and the number of shards (64 bits each, the latter inverted, as zeros are no end); so that what comes first is
/// known before all is.
class ShardJoiner {
public:
    explicit ShardJoiner(std::size_t count) : count_(count) {}
    /// The results of the next shard.
    void add(std::span<const std::byte> results);
    /// What stands behind the results that are there.
    std::vector<std::byte> tail() const;
    /// All of it. Leaves nothing here.
    Bytes finish();

private:
    void make_room(std::size_t more);

    std::size_t count_;
    std::vector<std::byte> joined_;
    std::vector<std::uint64_t> sizes_;
};

Bytes join_shards(std::span<const std::vector<std::byte>> shards);

/// Where the results are. Throws Error when `joined` was not made by join_shards().
std::vector<std::span<const std::byte>> split_shards(std::span<const std::byte> joined);
inline std::vector<std::span<const std::byte>> split_shards(const Bytes& joined) {
    return split_shards(joined ? std::span(*joined) : std::span<const std::byte>());
}

/// The results of a map(): one memory for all places of a process. Constant.
template <class T>
class Mapped {
public:
    explicit Mapped(Bytes joined) : joined_(std::move(joined)), shards_(split_shards(joined_)) {}

    std::size_t shards() const { return shards_.size(); }
    /// Results of one shard.
    std::span<const T> shard(std::size_t index) const { return as_results(shards_[index]); }
    /// Results of all, in the order of shards.
    std::span<const T> all() const {
        if (shards_.empty()) return {};
        const auto* first = shards_.front().data();
        return as_results({first, static_cast<std::size_t>(shards_.back().data() + shards_.back().size() - first)});
    }
    std::size_t size() const { return all().size(); }
    auto begin() const { return all().begin(); }
    auto end() const { return all().end(); }

private:
    static std::span<const T> as_results(std::span<const std::byte> bytes) {
        static_assert(alignof(T) <= 16);
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }

    Bytes joined_;
    std::vector<std::span<const std::byte>> shards_;
};

}  // namespace lightnet
