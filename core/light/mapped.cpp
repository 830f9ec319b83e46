#include "core/light/mapped.hpp"

#include <cstring>

#include "core/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);

}  // namespace

Bytes join_shards(std::span<const std::vector<std::byte>> shards) {
    const std::vector<std::span<const std::byte>> spans(shards.begin(), shards.end());
    return join_shards(std::span(spans));
}

Bytes join_shards(std::span<const std::span<const std::byte>> shards) {
    const std::uint64_t count = shards.size();
    std::size_t size = tail_of_joined(count);
    for (const auto& shard : shards) size += shard.size();
    auto joined = std::make_shared<std::vector<std::byte>>();
    joined->reserve(size);
    const auto append = [&](std::span<const std::byte> bytes) {
        joined->insert(joined->end(), bytes.begin(), bytes.end());
    };
    const auto append_number = [&](std::uint64_t number) { append(std::as_bytes(std::span(&number, 1))); };
    for (const auto& shard : shards) append(shard);
    for (const auto& shard : shards) append_number(shard.size());
    append_number(~count);
    return joined;
}

std::vector<std::span<const std::byte>> split_shards(const Bytes& joined) {
    const Error broken("results of preparing", "they are damaged");
    const std::size_t size = joined ? joined->size() : 0;
    std::uint64_t count = 0;
    if (size < word) throw broken;
    std::memcpy(&count, joined->data() + size - word, word);
    count = ~count;
    if (count > size / word - 1) throw broken;
    const std::size_t results = size - tail_of_joined(count);
    std::vector<std::span<const std::byte>> shards;
    std::size_t at = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, joined->data() + results + i * word, word);
        if (bytes > results - at) throw broken;
        shards.push_back({joined->data() + at, bytes});
        at += bytes;
    }
    if (at != results) throw broken;
    return shards;
}

}  // namespace lightnet
