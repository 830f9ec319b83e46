#include "core/film/checkpoint.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/film/pictures.hpp"
#include "tests/support/folder.hpp"

namespace lightnet {
namespace {

const FilmFormat format{8, 4, {"emission", "direct"}, 40};

// All tiles, with sums that are not exact, so that the order in which they are added shows.
std::vector<std::pair<Tile, std::vector<Rgb>>> all_tiles() {
    std::vector<std::pair<Tile, std::vector<Rgb>>> tiles;
    for (const auto& tile : tiles_of(format.width, format.height, 3, format.samples)) {
        std::vector<Rgb> pixels(tile.pixels() * format.layers.size());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = Rgb{0.1f, 1e-3f, 7.7f} * (1.f + 0.37f * static_cast<float>(i + tile.block() + tile.x));
        tiles.emplace_back(tile, std::move(pixels));
    }
    return tiles;
}

// Some blocks come before their turn, so that they have to wait.
Film half_a_film() {
    Film film(format);
    const auto tiles = all_tiles();
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (i % 3 != 1) film.add(tiles[i].first, tiles[i].second);
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
    for (const auto& [tile, pixels] : all_tiles()) {
        whole.add(tile, pixels);
        had += resumed.has(tile);
        EXPECT_EQ(resumed.add(tile, pixels), !half_a_film().has(tile));
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
