#include "core/readers/common/nanovdb_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "core/base/error.hpp"
#include "core/readers/common/nanovdb_tree.hpp"
#include "core/readers/files/blosc.hpp"
#include "core/readers/files/gzip.hpp"

namespace lightnet {
namespace nanovdb {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

enum Codec : std::uint16_t { plain = 0, zip = 1, blosc = 2 };

/// One grid of a file, as the file describes it.
struct StoredGrid {
    std::string name;
    std::uint64_t size = 0, stored = 0;  // bytes: unpacked, in the file
    std::uint32_t type = 0, kind = 0, version = 0;
    std::uint16_t codec = plain;
    std::span<const std::byte> bytes;
};

constexpr std::uint64_t magic_of(char last) {
    std::uint64_t magic = std::uint64_t(static_cast<unsigned char>(last)) << 56;
    for (int i = 0; i < 7; ++i) magic |= std::uint64_t("NanoVDB"[i]) << (8 * i);
    return magic;
}

// A file is a row of segments: a header, a description of each grid, the grids.
constexpr std::size_t header_size = 16, description_size = 176;

void check_segment(const Checked& file, std::uint64_t at) {
    const auto magic = file.get<std::uint64_t>(at);
    if (magic != magic_of('0') && magic != magic_of('2')) {
        constexpr std::uint64_t turned = 0x4e616e6f56444230;  // of a machine whose bytes run the other way
        if (magic == turned) refuse("its bytes are in the order of another kind of machine");
        if (magic == magic_of('1')) refuse("it is a grid without a file's header");
        refuse("it does not begin with 'NanoVDB0' or 'NanoVDB2'");
    }
    const auto version = file.get<std::uint32_t>(at + 8);
    if (version >> 21 != 32)
        refuse(fmt::format("version {}.{} is not known (32 is)", version >> 21, (version >> 10) & 0x7ff));
}

StoredGrid description_at(const Checked& file, std::uint64_t& at) {
    StoredGrid grid;
    grid.size = file.get<std::uint64_t>(at), grid.stored = file.get<std::uint64_t>(at + 8);
    grid.type = file.get<std::uint32_t>(at + 32), grid.kind = file.get<std::uint32_t>(at + 36);
    const auto name_size = file.get<std::uint32_t>(at + 136);
    grid.codec = file.get<std::uint16_t>(at + 168);
    const auto name = file.part(at + description_size, name_size);
    grid.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
    grid.name = grid.name.c_str();  // up to its end
    at += description_size + name_size;
    return grid;
}

std::vector<StoredGrid> grids_of(std::span<const std::byte> bytes) {
    const Checked file(bytes);
    std::vector<StoredGrid> grids;
    std::uint64_t at = 0;
    do {
        check_segment(file, at);
        const auto count = file.get<std::uint16_t>(at + 12);
        const std::size_t first = grids.size();
        at += header_size;
        for (std::uint16_t i = 0; i < count; ++i) grids.push_back(description_at(file, at));
        for (std::size_t i = first; i < grids.size(); ++i) {
            grids[i].bytes = file.part(at, grids[i].stored);
            at += grids[i].stored;
        }
    } while (at < bytes.size());
    return grids;
}

std::string type_name(std::uint32_t type) {
    constexpr std::array names{"unknown", "float", "double", "int16",  "int32", "int64", "Vec3f",
                               "Vec3d",   "mask",  "half",   "uint32", "bool",  "RGBA8", "Fp4",
                               "Fp8",     "Fp16",  "FpN",    "Vec4f",  "Vec4d"};
    return type < names.size() ? names[type] : fmt::format("{}", type);
}

/// Pieces of one GiB, each by itself.
std::vector<std::byte> unpacked_by_blosc(const StoredGrid& grid) {
    constexpr std::uint64_t piece = std::uint64_t{1} << 30, least = std::uint64_t{1} << 20, most_ratio = 512;
    if (grid.size > least + most_ratio * grid.bytes.size()) refuse("its grid is larger than Blosc can have packed");
    const Checked packed(grid.bytes);
    std::vector<std::byte> all(grid.size);
    for (std::uint64_t from = 0, to = 0; to < all.size(); to += piece) {
        const auto size = packed.get<std::uint64_t>(from);
        unpack_blosc(packed.part(from + 8, size), std::span(all).subspan(to).first(std::min(piece, all.size() - to)));
        from += 8 + size;
    }
    return all;
}

/// The bytes of a grid, in `room` if they were packed.
std::span<const std::byte> unpacked(const StoredGrid& grid, std::vector<std::byte>& room) {
    if (grid.codec == plain) return grid.bytes;
    if (grid.codec == blosc) return room = unpacked_by_blosc(grid);
    if (grid.codec != zip) refuse(fmt::format("it is packed by an unknown codec ({})", grid.codec));
    const Checked packed(grid.bytes);
    return room = unzip(packed.part(8, packed.get<std::uint64_t>(0)), grid.size);
}

void check_grid(const StoredGrid& stored, const Checked& grid) {
    const auto magic = grid.get<std::uint64_t>(0);
    if (magic != magic_of('0') && magic != magic_of('1')) refuse("a grid does not begin with 'NanoVDB0' or 'NanoVDB1'");
    constexpr std::uint32_t float_type = 1, unknown_kind = 0, fog = 2;
    if (stored.type != float_type || grid.get<std::uint32_t>(636) != float_type)
        refuse(fmt::format("grid '{}' is of type {}, not float", stored.name, type_name(stored.type)));
    const auto kind = grid.get<std::uint32_t>(632);
    if (kind != unknown_kind && kind != fog) refuse(fmt::format("grid '{}' is not a fog volume", stored.name));
}

}  // namespace
}  // namespace nanovdb

std::vector<std::string> names_in_nanovdb(std::span<const std::byte> bytes) {
    std::vector<std::string> names;
    for (auto& grid : nanovdb::grids_of(bytes)) names.push_back(std::move(grid.name));
    return names;
}

std::optional<SparseGrid> read_nanovdb(std::span<const std::byte> bytes, std::string_view name) {
    for (const nanovdb::StoredGrid& stored : nanovdb::grids_of(bytes)) {
        if (stored.name != name) continue;
        std::vector<std::byte> room;
        const nanovdb::Checked grid(nanovdb::unpacked(stored, room));
        nanovdb::check_grid(stored, grid);
        return nanovdb::tree_in(grid);
    }
    return std::nullopt;
}

}  // namespace lightnet
