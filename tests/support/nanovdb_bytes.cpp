#include "tests/support/nanovdb_bytes.hpp"

#include <blosc.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace lightnet::test {
namespace {

using Place = std::array<std::int32_t, 3>;

template <class Value>
void put(std::string& bytes, std::size_t at, Value value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}
void set_bit(std::string& bytes, std::size_t mask, std::uint32_t n) {
    bytes[mask + n / 8] = static_cast<char>(static_cast<unsigned char>(bytes[mask + n / 8]) | 1u << n % 8);
}

Place rounded(const Place& p, int bits) { return {p[0] >> bits << bits, p[1] >> bits << bits, p[2] >> bits << bits}; }
/// Of the part of a node that a place lies in: parts are 2^bits points wide, and there are 2^log of them along an axis.
std::uint32_t part(const Place& p, int bits, int log) {
    const auto along = [&](std::size_t axis) { return std::uint32_t(p[axis] >> bits) & ((1u << log) - 1); };
    return along(0) << 2 * log | along(1) << log | along(2);
}

constexpr std::size_t root_at = 672 + 64, upper_size = 270400, lower_size = 33856, leaf_size = 2144;

}  // namespace

std::string nanovdb_grid(const NanovdbPoints& grid) {
    std::set<Place> places[3];  // of leaves, lower nodes, upper nodes
    for (const auto& [place, value] : grid.points)
        for (int level = 0; level < 3; ++level) places[level].insert(rounded(place, std::array{3, 7, 12}[level]));
    std::string bytes(root_at + 64 + 32 * places[2].size(), '\0');
    const auto reserve = [&](const std::set<Place>& of, std::size_t size) {
        std::map<Place, std::size_t> at;
        for (const Place& place : of) {
            at[place] = bytes.size();
            bytes.resize(bytes.size() + size);
        }
        return at;
    };
    const auto uppers = reserve(places[2], upper_size), lowers = reserve(places[1], lower_size),
               leaves = reserve(places[0], leaf_size);
    std::memcpy(bytes.data(), "NanoVDB0", 8);
    put(bytes, 16, std::uint32_t{32u << 21 | 4u << 10});
    put(bytes, 28, std::uint32_t{1});
    put(bytes, 32, std::uint64_t{bytes.size()});
    std::memcpy(bytes.data() + 40, grid.name.data(), std::min<std::size_t>(grid.name.size(), 255));
    for (std::size_t i = 0; i < 3; ++i) {
        put(bytes, 296 + 88 + 32 * i, grid.step);
        put(bytes, 296 + 232 + 8 * i, grid.origin[i]);
    }
    put(bytes, 632, grid.kind), put(bytes, 636, grid.type);
    put(bytes, 672 + 24, std::uint64_t{64});  // the root
    put(bytes, root_at + 24, std::uint32_t(uppers.size()));
    std::size_t tile = root_at + 64;
    for (const auto& [place, at] : uppers) {
        const auto key = [&, &place = place](std::size_t axis) {
            return std::uint64_t{std::uint32_t(place[axis]) >> 12};
        };
        put(bytes, tile, key(2) | key(1) << 21 | key(0) << 42);
        put(bytes, tile + 8, std::uint64_t{at - root_at});
        tile += 32;
    }
    for (const auto& [place, at] : lowers) {
        const std::size_t above = uppers.at(rounded(place, 12));
        const std::uint32_t n = part(place, 7, 5);
        set_bit(bytes, above + 4128, n);
        put(bytes, above + 8256 + 8 * n, std::uint64_t{at - above});
    }
    for (const auto& [place, at] : leaves) {
        const std::size_t above = lowers.at(rounded(place, 7));
        const std::uint32_t n = part(place, 3, 4);
        set_bit(bytes, above + 544, n);
        put(bytes, above + 1088 + 8 * n, std::uint64_t{at - above});
    }
    for (const auto& [place, value] : grid.points) {
        const std::size_t leaf = leaves.at(rounded(place, 3));
        const std::uint32_t n = part(place, 0, 3);
        set_bit(bytes, leaf + 16, n);
        put(bytes, leaf + 96 + 4 * n, value);
    }
    return bytes;
}

std::string nanovdb_file(const std::vector<NanovdbPoints>& grids, std::uint16_t codec) {
    std::string head(16, '\0'), bodies;
    std::memcpy(head.data(), "NanoVDB0", 8);
    put(head, 8, std::uint32_t{32u << 21 | 4u << 10});
    put(head, 12, std::uint16_t(grids.size())), put(head, 14, codec);
    for (const NanovdbPoints& grid : grids) {
        const std::string whole = nanovdb_grid(grid);
        std::string stored = whole;
        if (codec == 1) {
            uLongf size = compressBound(uLong(whole.size()));
            stored.assign(8 + size, '\0');
            compress(reinterpret_cast<Bytef*>(stored.data() + 8), &size, reinterpret_cast<const Bytef*>(whole.data()),
                     uLong(whole.size()));
            stored.resize(8 + size);
            put(stored, 0, std::uint64_t{size});
        }
        if (codec == 2) {
            stored.assign(8 + whole.size() + 1024, '\0');
            const int size = blosc_compress_ctx(9, 1, 4, whole.size(), whole.data(), stored.data() + 8,
                                                stored.size() - 8, "lz4", 0, 1);
            stored.resize(std::size_t(8 + size));
            put(stored, 0, std::uint64_t(size));
        }
        const std::size_t at = head.size();
        head.resize(at + 176);
        put(head, at, std::uint64_t{whole.size()}), put(head, at + 8, std::uint64_t{stored.size()});
        put(head, at + 32, grid.type), put(head, at + 36, grid.kind);
        put(head, at + 136, std::uint32_t(grid.name.size() + 1)), put(head, at + 168, codec);
        head += grid.name + '\0';
        bodies += stored;
    }
    return head + bodies;
}

}  // namespace lightnet::test
