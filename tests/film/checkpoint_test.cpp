#include "core/film/checkpoint.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/film/pictures.hpp"
#include "tests/support/folder.hpp"

namespace lightnet {
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
}  // namespace lightnet
