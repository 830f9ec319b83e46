#include "core/network/light/mapped.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);

// Bytes behind the results of so many shards.
constexpr std::size_t tail_of_joined(std::size_t shards) { return (shards + 1) * word; }

}  // namespace

// Room for all, if the others are like those that are there: what is moved to a larger room is moved in vain.
void ShardJoiner::make_room(std::size_t more) {
    const std::size_t size = joined_.size() + more, shards = sizes_.size() + 1;
    if (size <= joined_.capacity()) return;
    joined_.reserve(size + size / shards * (count_ - std::min(count_, shards)) * 17 / 16 + tail_of_joined(count_));
}

void ShardJoiner::add(std::span<const std::byte> results) {
    make_room(results.size());
    joined_.insert(joined_.end(), results.begin(), results.end());
    sizes_.push_back(results.size());
}

std::vector<std::byte> ShardJoiner::tail() const {
    std::vector<std::uint64_t> numbers = sizes_;
    numbers.push_back(~std::uint64_t{sizes_.size()});
    const auto bytes = std::as_bytes(std::span(numbers));
    return {bytes.begin(), bytes.end()};
}

Bytes ShardJoiner::finish() {
    const auto end = tail();
    joined_.insert(joined_.end(), end.begin(), end.end());
    return std::make_shared<const std::vector<std::byte>>(std::move(joined_));
}

Bytes join_shards(std::span<const std::vector<std::byte>> shards) {
    ShardJoiner joiner(shards.size());
    for (const auto& shard : shards) joiner.add(shard);
    return joiner.finish();
}

std::vector<std::span<const std::byte>> split_shards(std::span<const std::byte> joined) {
    const Error broken("results of preparing", "they are damaged");
    const std::size_t size = joined.size();
    std::uint64_t count = 0;
    if (size < word) throw broken;
    std::memcpy(&count, joined.data() + size - word, word);
    count = ~count;
    if (count > size / word - 1) throw broken;
    const std::size_t results = size - tail_of_joined(count);
    std::vector<std::span<const std::byte>> shards;
    std::size_t at = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, joined.data() + results + i * word, word);
        if (bytes > results - at) throw broken;
        shards.push_back({joined.data() + at, bytes});
        at += bytes;
    }
    if (at != results) throw broken;
    return shards;
}

}  // namespace lightnet
