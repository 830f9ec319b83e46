#include "core/readers/common/vdb_file.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/readers/common/vdb_stream.hpp"

namespace lightnet {
namespace vdb {
namespace {

using sparse::Place;

constexpr std::uint64_t magic = 0x56444220;
constexpr std::string_view half_suffix = "_HalfFloat";

/// One grid of a file, as the file describes it.
struct StoredGrid {
    std::string name, type, shares;  // `shares`: the grid whose tree it has; "": one of its own
    bool half = false;
    std::uint64_t at = 0, numbers_at = 0;  // what it is; the numbers of its leaves
};

using Facts = std::vector<std::pair<std::string, std::string>>;  // names and bytes

Facts facts_in(Stream& stream) {
    Facts facts;
    const auto count = stream.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        std::string name = stream.text();
        stream.text();  // its type
        facts.emplace_back(std::move(name), stream.text());
    }
    return facts;
}

StoredGrid description_in(Stream& stream) {
    StoredGrid grid;
    grid.name = stream.text(), grid.type = stream.text(), grid.shares = stream.text();
    grid.name = grid.name.substr(0, grid.name.find('\x1e'));  // a number after it tells equal names apart
    grid.half = grid.type.ends_with(half_suffix);
    if (grid.half) grid.type.resize(grid.type.size() - half_suffix.size());
    grid.at = stream.get<std::uint64_t>(), grid.numbers_at = stream.get<std::uint64_t>();
    return grid;
}

std::vector<StoredGrid> grids_of(std::span<const std::byte> bytes) {
    Stream stream(bytes);
    if (stream.get<std::uint64_t>() != magic) throw Error("it does not begin as an OpenVDB file does");
    const auto version = stream.get<std::uint32_t>();
    if (version < 222 || version > 224)
        throw Error(fmt::format("version {} of OpenVDB's format is not known (222 to 224 are)", version));
    stream.part(8);  // of the library
    if (stream.get<std::uint8_t>() == 0)
        throw Error("it was written to a stream, without saying where its grids are: write it to a file");
    stream.part(36);  // its own number
    facts_in(stream);
    std::vector<StoredGrid> grids;
    const auto count = stream.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        grids.push_back(description_in(stream));
        const auto end = stream.get<std::uint64_t>();
        if (i + 1 == count) break;
        if (end < stream.at()) throw Error("a grid ends before it begins");  // or there would be no end of them
        stream = Stream(bytes, end);
    }
    return grids;
}

/// From steps of the grid to the file's world.
Matrix map_in(Stream& stream) {
    const std::string type = stream.text();
    Matrix map;
    const auto translate = [&] {
        for (std::size_t axis = 0; axis < 3; ++axis) map.m[axis][3] = stream.get<double>();
    };
    const auto scale = [&] {
        for (std::size_t axis = 0; axis < 3; ++axis) map.m[axis][axis] = stream.get<double>();
        stream.part(4 * 3 * sizeof(double));  // what follows from it
    };
    if (type == "AffineMap" || type == "UnitaryMap") {  // of rows
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                if (const auto number = stream.get<double>(); j < 3) map.m[j][i] = number;
    } else if (type == "TranslationMap") {
        translate();
    } else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") {
        translate(), scale();
    } else if (type == "ScaleMap" || type == "UniformScaleMap") {
        scale();
    } else {
        throw Error("its transform is " + in_quotes(type) + ", which is not affine");
    }
    return map;
}

struct Level {
    std::uint32_t bits, shift;  // see sparse::part_of()
    std::uint32_t parts() const { return 1u << 3 * bits; }
    std::int64_t wide() const { return std::int64_t{1} << shift; }
};
constexpr Level upper{5, 7}, lower{4, 3};
constexpr std::int64_t root_wide = 4096;

struct Leaf {
    Place origin;
    Mask active;
};

/// What is in a tree but for the numbers of its leaves.
class Contents {
public:
    Contents(Stream& stream, Storage& storage) : stream_(stream), storage_(storage) { read_root(); }

    const sparse::Span& active() const { return active_; }
    const std::vector<sparse::Tile>& tiles() const { return tiles_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }

private:
    void add_tile(const Place& origin, std::int64_t wide, float value, bool active) {
        value = sparse::sound_value(value);
        if (active) active_.add(origin, {origin[0] + wide - 1, origin[1] + wide - 1, origin[2] + wide - 1});
        if (value == sparse::sound_value(storage_.background)) return;
        tiles_.push_back({origin, wide, value});
        if (tiles_.size() * sizeof(sparse::Tile) > (std::size_t{1} << 26) + 8 * stream_.file_size())
            throw Error("it has too many parts of one value each");
    }
    Place root_place() {
        Place place;
        for (auto& axis : place) {
            axis = stream_.get<std::int32_t>();
            if (axis % root_wide != 0) throw Error("a node of its tree lies between the places for nodes");
        }
        return place;
    }

    void read_root() {
        if (stream_.get<std::uint32_t>() != 1) throw Error("it has more than one buffer for each leaf");
        storage_.background = number(stream_, storage_);
        sparse::sound_value(storage_.background);
        const auto tiles = stream_.get<std::uint32_t>(), children = stream_.get<std::uint32_t>();
        for (std::uint32_t n = 0; n < tiles; ++n) {
            const Place origin = root_place();
            const float value = number(stream_, storage_);
            add_tile(origin, root_wide, value, stream_.get<std::uint8_t>() != 0);
        }
        for (std::uint32_t n = 0; n < children; ++n)
            read_node(upper, root_place(),
                      [&](const Place& at) { read_node(lower, at, [&](const Place& leaf) { read_leaf(leaf); }); });
    }
    template <class Child>
    void read_node(const Level& level, const Place& origin, const Child& read_child) {
        const Mask children = stream_.mask(level.parts()), active = stream_.mask(level.parts());
        const auto values = numbers(stream_, active, level.parts(), storage_);
        for (std::uint32_t n = 0; n < level.parts(); ++n)
            if (!children[n])
                add_tile(sparse::part_of(origin, n, level.bits, level.shift), level.wide(), values[n], active[n]);
        for (std::uint32_t n = 0; n < level.parts(); ++n)
            if (children[n]) read_child(sparse::part_of(origin, n, level.bits, level.shift));
    }
    void read_leaf(const Place& origin) {
        leaves_.push_back({origin, stream_.mask(VolumeGrid::block_points)});
        active_.add_leaf(origin, leaves_.back().active.bytes().first<64>());
    }

    Stream& stream_;
    Storage& storage_;
    sparse::Span active_;
    std::vector<sparse::Tile> tiles_;
    std::vector<Leaf> leaves_;
};

SparseGrid grid_in(std::span<const std::byte> bytes, const StoredGrid& stored) {
    const auto refuse = [&](const std::string& why) { throw Error("grid " + in_quotes(stored.name) + " " + why); };
    using Number = Storage::Number;
    const bool twice = stored.type == "Tree_double_5_4_3";
    if (!twice && stored.type != "Tree_float_5_4_3")
        refuse("is of type " + in_quotes(stored.type) + ", neither float nor double");
    if (!stored.shares.empty()) refuse("has the tree of another grid: write it as one of its own");
    Stream stream(bytes, stored.at);
    const Number alone = twice ? Number::twice : Number::single;
    Storage storage{stream.get<std::uint32_t>(), stored.half ? Number::half : alone, alone, 0};
    for (const auto& [name, value] : facts_in(stream))
        if (name == "class" && value != "fog volume" && value != "unknown") refuse("is not a fog volume");
    const Matrix to_world = map_in(stream);
    const Contents contents(stream, storage);
    sparse::Blocks blocks(contents.active(), sparse::sound_value(storage.background), bytes.size());
    for (const sparse::Tile& tile : contents.tiles()) blocks.fill(tile);
    Stream leaves(bytes, stored.numbers_at);
    for (const Leaf& leaf : contents.leaves()) {
        const Mask active = leaves.mask(VolumeGrid::block_points);
        const auto values = numbers(leaves, active, VolumeGrid::block_points, storage);
        blocks.copy(leaf.origin, std::span(values).first<VolumeGrid::block_points>());
    }
    return blocks.take(to_world);
}

}  // namespace
}  // namespace vdb

bool is_vdb(std::span<const std::byte> bytes) {
    return bytes.size() >= 8 && CheckedBytes(bytes).get<std::uint64_t>(0) == vdb::magic;
}

std::vector<std::string> names_in_vdb(std::span<const std::byte> bytes) {
    std::vector<std::string> names;
    for (auto& grid : vdb::grids_of(bytes)) names.push_back(std::move(grid.name));
    return names;
}

std::optional<SparseGrid> read_vdb(std::span<const std::byte> bytes, std::string_view name) {
    for (const vdb::StoredGrid& stored : vdb::grids_of(bytes))
        if (stored.name == name) return vdb::grid_in(bytes, stored);
    return std::nullopt;
}

}  // namespace lightnet
