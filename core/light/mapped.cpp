#include "core/light/mapped.hpp"

#include <cstring>

#include "core/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);

std::size_t head_of(std::uint64_t shards) { return ((shards + 1) * word + 15) / 16 * 16; }

}  // namespace

Bytes join_shards(std::span<const std::vector<std::byte>> shards) {
    const std::vector<std::span<const std::byte>> spans(shards.begin(), shards.end());
    return join_shards(std::span(spans));
}

Bytes join_shards(std::span<const std::span<const std::byte>> shards) {
    const std::uint64_t count = shards.size();
    std::size_t size = head_of(count);
    for (const auto& shard : shards) size += shard.size();
    auto joined = std::make_shared<std::vector<std::byte>>(size);
    std::memcpy(joined->data(), &count, word);
    std::size_t at = head_of(count);
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const std::uint64_t bytes = shards[i].size();
        std::memcpy(joined->data() + (i + 1) * word, &bytes, word);
        if (bytes) std::memcpy(joined->data() + at, shards[i].data(), bytes);
        at += bytes;
    }
    return joined;
}

std::vector<std::span<const std::byte>> split_shards(const Bytes& joined) {
    const Error broken("results of preparing", "they are damaged");
    const std::size_t size = joined ? joined->size() : 0;
    std::uint64_t count = 0;
    if (size < word) throw broken;
    std::memcpy(&count, joined->data(), word);
    if (count > size / word || head_of(count) > size) throw broken;
    std::vector<std::span<const std::byte>> shards;
    std::size_t at = head_of(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, joined->data() + (i + 1) * word, word);
        if (bytes > size - at) throw broken;
        shards.push_back({joined->data() + at, bytes});
        at += bytes;
    }
    if (at != size) throw broken;
    return shards;
}

}  // namespace lightnet
