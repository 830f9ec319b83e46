#include "core/film/checkpoint.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "tests/film/pictures.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::checkpoint_test {
namespace {

const FilmFormat format{8, 4, {"emission", "direct"}, 300};

// Sums that are not exact, so that the order in which they are added shows.
std::vector<Rgb> rendered(const Tile& tile) {
    std::vector<Rgb> pixels(tile.pixels() * format.layers.size());
    for (const Tile& block : one_by_one(tile))
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const auto colour = Rgb{0.1f, 1e-3f, 7.7f} * (1.f + 0.37f * static_cast<float>(i + block.block() + tile.x));
            pixels[i] = block.block() == tile.block() ? colour : pixels[i] + colour;
        }
    return pixels;
}

std::vector<Tile> all_tiles() { return tiles_of(format.width, format.height, 3, format.samples); }

// Some tiles come before their turn, and some block by block and not whole, so that they have to wait.
Film half_a_film() {
    Film film(format);
    const auto tiles = all_tiles();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (i % 3 == 0) film.add(tiles[i], rendered(tiles[i]));
        if (i % 3 != 1) continue;
        const auto blocks = one_by_one(tiles[i]);
        for (std::size_t k = 0; k < blocks.size(); ++k)
            if (k % 4 != 2 && blocks.size() > 1) film.add(blocks[k], rendered(blocks[k]));
    }
    return film;
}

TEST(Checkpoint, GoesOnToTheSameBytes) {
    const test::Folder folder;
    const auto path = checkpoint_beside(folder / "x.exr");
    EXPECT_EQ(path.filename(), "x.exr.checkpoint");
    EXPECT_FALSE(read_checkpoint(path));
    write_checkpoint(path, {{{"seed", "7"}}, half_a_film().state()});
    const auto found = read_checkpoint(path);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->of.at("seed"), "7");

    Film whole(format), resumed(format);
    resumed.restore(found->film);
    std::size_t had = 0;
    for (const auto& tile : all_tiles()) {
        whole.add(tile, rendered(tile));
        had += resumed.has(tile);
        EXPECT_EQ(resumed.add(tile, rendered(tile)), !half_a_film().has(tile));
    }
    EXPECT_GT(had, 0u);
    EXPECT_TRUE(resumed.complete());
    EXPECT_EQ(resumed.picture().beauty, whole.picture().beauty);
}

TEST(Checkpoint, ThatIsDamagedAnywhereIsRefused) {
    const test::Folder folder;
    const auto path = folder / "x.checkpoint";
    write_checkpoint(path, {{{"seed", "7"}}, half_a_film().state()});
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    for (std::size_t i = 0; i < bytes.size(); i += 97) {
        auto changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ 4);
        std::ofstream(path, std::ios::binary) << changed;
        EXPECT_THROW(read_checkpoint(path), Error) << i;
        std::ofstream(path, std::ios::binary) << bytes.substr(0, i);
        EXPECT_THROW(read_checkpoint(path), Error) << i;
    }
}

// The text of a checkpoint changed, and its hash made right again.
void rewrite(const std::filesystem::path& path, const std::string& before, const std::string& after) {
    std::string bytes = content_of(path);
    constexpr std::size_t hash_size = sizeof(Hash::bytes);
    const auto at = bytes.find(before), size_at = bytes.find('\n') + 1;
    ASSERT_NE(at, std::string::npos) << before;
    std::uint64_t size = 0;
    std::memcpy(&size, &bytes[size_at], sizeof size);
    size += after.size() - before.size();
    std::memcpy(&bytes[size_at], &size, sizeof size);
    bytes.replace(at, before.size(), after);
    bytes.resize(bytes.size() - hash_size);
    const Hash hash = content_hash(bytes);
    std::ofstream(path, std::ios::binary) << bytes << std::string(hash.bytes.begin(), hash.bytes.end());
}

std::string refusal_of(const std::filesystem::path& path) {
    try {
        Film(format).restore(read_checkpoint(path).value().film);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Checkpoint, WhosePartsAreNoneOfOursIsRefusedInASentence) {
    const test::Folder folder;
    const auto path = folder / "x.checkpoint";
    const auto refused = [&](const std::string& before, const std::string& after, const char* why) {
        Film film(format);
        const Tile first = all_tiles()[0];
        film.add(first, rendered(first));
        write_checkpoint(path, {{{"seed", "7"}}, film.state()});
        rewrite(path, before, after);
        EXPECT_THAT(refusal_of(path), testing::HasSubstr(why)) << before << " -> " << after;
    };
    const std::string part = "[0,0,3,3,1,[],false]";
    refused("[" + part + "]", "[]", "lacks a part");
    refused(part, "[]", "a part of it is damaged");
    refused(part, "[0,0,3,3,1]", "a part of it is damaged");
    refused(part, "[0,0,3,3,1,7,false]", "a part of it is damaged");
    refused(part, "[0,0,3,3,1,[[]],false]", "a part of it is damaged");
    refused(part, "[0,0,3,3,1,[],2]", "a part of it is damaged");
    refused(part, "[0,0,3,3,1,[],true]", "a part that ended too early");
    refused(part, "null", "a part of it is damaged");
    refused(part, "[0,0,3,3,-1,[],false]", "damaged");
    refused(part, "[0,0,3,3,1.5,[],false]", "damaged");
    refused(part, "[0,0,4294967299,3,1,[],false]", "damaged");
    refused(part, "[0,0,0,3,1,[],false]", "no tile of this picture");
    refused(part, part + "," + part, "a part twice");
    refused(part, part + ",[1,0,3,3,1,[],false]", "overlap");
    refused(part, "[0,0,3,3,0,[],false]", "lacks a part");
    refused(part, "[0,0,3,3,1,[[5,1,0],[5,1,0]],false]", "a block twice");
    refused("\"parts\"", "\"pants\"", "damaged");
    refused("\"of\":{", "\"of\":[{", "damaged");
    refused("\"lost\":[0,0]", "\"lost\":[0]", "another size");
    refused("\"sums\":64", "\"sums\":63", "holds more than it says");
    refused("\"samples\":300", "\"samples\":301", "of more samples");
}

TEST(Checkpoint, QuotesNothingThatCommandsATerminal) {
    EXPECT_EQ(differences({{"seed", "7\x1b[2J\n\x07"}}, {{"seed", "8"}}), "seed 7\\x1b[2J\\x0a\\x07 there, 8 here");
}

TEST(Checkpoint, OfAnotherVersionSaysSo) {
    const test::Folder folder;
    folder.write("x.checkpoint", "lightnet checkpoint 3\nand more");
    EXPECT_THAT(refusal_of(folder / "x.checkpoint"), testing::HasSubstr("another version"));
}

TEST(Checkpoint, WithBlocksThatCantWaitDoesNotFit) {
    const auto refused = [](const auto& spoil) {
        FilmState state = half_a_film().state();
        for (auto& part : state.parts) spoil(part);
        EXPECT_THROW(Film(format).restore(std::move(state)), Error);
    };
    refused([](auto& part) { part.next_block = 3; });  // within a group
    refused([](auto& part) { part.next_block = 40; });
    const auto sum = [](const auto& part, std::uint32_t blocks) {
        return FilmState::Sum{blocks, std::vector<Rgb>(std::size_t{part.width} * part.height * 2)};
    };
    refused([&](auto& part) { part.waiting = {{19, sum(part, 1)}}; });                     // there is none
    refused([&](auto& part) { part.waiting = {{16, sum(part, 4)}}; });                     // beyond its group
    refused([&](auto& part) { part.waiting = {{8, sum(part, 3)}, {10, sum(part, 1)}}; });  // twice
    refused([&](auto& part) { part.waiting = {{17, sum(part, 0)}}; });
    refused([&](auto& part) { part.waiting = {{17, {1, {}}}}; });
    refused([&](auto& part) {  // its turn has come
        part.next_block = 0;
        part.waiting = {{0, sum(part, 1)}};
    });
}

TEST(Checkpoint, OfAnotherFormatDoesNotFit) {
    auto other = format;
    other.width = 9;
    EXPECT_THROW(Film(other).restore(half_a_film().state()), Error);
    other = format;
    other.samples = 16;
    EXPECT_THROW(Film(other).restore(half_a_film().state()), Error) << "it has blocks that this film has not";
    Film used = half_a_film();
    EXPECT_THROW(used.restore(half_a_film().state()), Error);
}

TEST(Checkpoint, TellsWhatDiffers) {
    EXPECT_EQ(differences({{"seed", "7"}, {"size", "8x8"}}, {{"seed", "7"}, {"size", "8x8"}}), "");
    EXPECT_EQ(differences({{"seed", "7"}}, {{"seed", "8"}, {"size", "8x8"}}),
              "seed 7 there, 8 here; size unknown there, 8x8 here");
    EXPECT_EQ(differences({{"graph", std::string(64, 'a')}}, {{"graph", std::string(64, 'b')}}), "graph");
}

}  // namespace
}  // namespace lightnet::checkpoint_test
