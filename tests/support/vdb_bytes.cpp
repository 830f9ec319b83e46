#include "tests/support/vdb_bytes.hpp"

#include <blosc.h>
#include <half.h>
#include <zlib.h>

#include <cstring>

namespace lightnet::test {
namespace {

using VdbPlace = std::array<std::int32_t, 3>;
using VdbPoints = std::map<VdbPlace, float>;

template <class... Values>
std::string bytes_of_values(const Values&... values) {
    std::string bytes;
    (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    return bytes;
}

std::string text(const std::string& words) { return bytes_of_values(std::uint32_t(words.size())) + words; }

/// Which part of a node, 2^bits points wide each, and 2^log along an axis, a place lies in.
std::uint32_t part_number(const VdbPlace& p, int bits, int log) {
    const auto along = [&](std::size_t axis) { return std::uint32_t(p[axis] >> bits) & ((1u << log) - 1); };
    return along(0) << 2 * log | along(1) << log | along(2);
}

std::string packed(const std::string& bytes, std::uint32_t packing) {
    if (!(packing & 5)) return bytes;
    std::string to(bytes.size() + 1024, '\0');
    std::int64_t size = 0;
    if (packing & 4) {
        size = blosc_compress_ctx(9, 1, 4, bytes.size(), bytes.data(), to.data(), to.size(), "lz4", 0, 1);
    } else {
        uLongf room = uLongf(to.size());
        compress(reinterpret_cast<Bytef*>(to.data()), &room, reinterpret_cast<const Bytef*>(bytes.data()),
                 uLong(bytes.size()));
        size = std::int64_t(room);
    }
    if (size <= 0 || std::size_t(size) >= bytes.size())
        return bytes_of_values(-std::int64_t(bytes.size())) + bytes;  // as it is
    return bytes_of_values(size) + to.substr(0, std::size_t(size));
}

/// Numbers of a node of so many parts; what is not among them is 0.
std::string stored(const std::map<std::uint32_t, float>& values, std::uint32_t parts, const VdbStorage& storage) {
    const bool active_only = storage.packing & 2;
    std::string plain;
    const auto put = [&](float value) {
        plain += storage.half ? bytes_of_values(half(value).bits()) : bytes_of_values(value);
    };
    for (std::uint32_t n = 0; n < parts; ++n) {
        const auto found = values.find(n);
        if (found != values.end())
            put(found->second);
        else if (!active_only)
            put(0);
    }
    const std::string how(1, active_only ? '\0' : '\6');
    return how + (plain.empty() && storage.half ? "" : packed(plain, storage.packing));
}

template <class Entries>
std::string mask_of(const Entries& entries, std::uint32_t parts) {
    std::string mask(parts / 8, '\0');
    for (const auto& [n, entry] : entries)
        mask[n / 8] = static_cast<char>(static_cast<unsigned char>(mask[n / 8]) | 1u << n % 8);
    return mask;
}

/// Places of the parts of a node that have points.
std::map<std::uint32_t, VdbPoints> parts_of(const VdbPoints& points, int bits, int log) {
    std::map<std::uint32_t, VdbPoints> parts;
    for (const auto& [place, value] : points) parts[part_number(place, bits, log)][place] = value;
    return parts;
}

/// A tree, and the numbers of its leaves.
struct TreeBytes {
    std::string tree, leaves;
};

void add_leaf(const VdbPoints& points, const VdbStorage& storage, TreeBytes& to) {
    std::map<std::uint32_t, float> values;
    for (const auto& [place, value] : points) values[part_number(place, 0, 3)] = value;
    to.tree += mask_of(values, 512);
    to.leaves += mask_of(values, 512) + stored(values, 512, storage);
}

void add_node(const VdbPoints& points, int bits, int log, const VdbStorage& storage, TreeBytes& to) {
    const auto parts = parts_of(points, bits, log);
    const std::uint32_t count = 1u << 3 * log;
    to.tree += mask_of(parts, count) + std::string(count / 8, '\0') + stored({}, count, storage);
    for (const auto& [n, inside] : parts) {
        if (bits == 3)
            add_leaf(inside, storage, to);
        else
            add_node(inside, 3, 4, storage, to);
    }
}

TreeBytes tree_of(const VdbPoints& points, const VdbStorage& storage) {
    std::map<VdbPlace, VdbPoints> nodes;
    for (const auto& [place, value] : points)
        nodes[{place[0] >> 12 << 12, place[1] >> 12 << 12, place[2] >> 12 << 12}][place] = value;
    TreeBytes bytes{bytes_of_values(std::int32_t{1}, 0.f, std::uint32_t{0}, std::uint32_t(nodes.size())), ""};
    for (const auto& [origin, inside] : nodes) {
        bytes.tree += bytes_of_values(origin);
        add_node(inside, 7, 5, storage, bytes);
    }
    return bytes;
}

std::string transform_of(const NanovdbPoints& grid, const VdbStorage& storage) {
    const double step = grid.step;
    std::string bytes = text(storage.transform) + bytes_of_values(grid.origin);
    for (const double number : {step, step, 1 / step, 1 / (step * step), 0.5 / step})
        bytes += bytes_of_values(number, number, number);
    return bytes;
}

}  // namespace

std::string vdb_file(const std::vector<NanovdbPoints>& grids, const VdbStorage& storage) {
    std::string bytes = bytes_of_values(std::uint64_t{0x56444220}, std::uint32_t{224}, std::uint32_t{10},
                                        std::uint32_t{0}, std::uint8_t{1}) +
                        std::string(36, 'a') + bytes_of_values(std::uint32_t{0}, std::uint32_t(grids.size()));
    for (const NanovdbPoints& grid : grids) {
        const auto tree = tree_of(grid.points, storage);
        bytes += text(grid.name) + text(storage.type + (storage.half ? "_HalfFloat" : "")) + text("");
        const std::string head = bytes_of_values(storage.packing, std::uint32_t{1}) + text("class") + text("string") +
                                 text(storage.kind) + transform_of(grid, storage);
        const std::uint64_t at = bytes.size() + 24, leaves = at + head.size() + tree.tree.size(),
                            end = leaves + tree.leaves.size();
        bytes += bytes_of_values(at, leaves, end) + head + tree.tree + tree.leaves;
    }
    return bytes;
}

}  // namespace lightnet::test
