// Files of NanoVDB: what is read of them, and what is not believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <span>

#include "core/base/error.hpp"
#include "core/readers/common/nanovdb_file.hpp"
#include "tests/support/nanovdb_bytes.hpp"

namespace lightnet::test::nanovdb_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

NanovdbPoints some_points() {
    NanovdbPoints grid;
    grid.step = 0.5, grid.origin = {1, 2, 3};
    grid.points = {{{0, 0, 0}, 1}, {{1, 0, 0}, 3},    {{-1, 5, 7}, 0.5f},
                   {{7, 7, 7}, 2}, {{8, -9, 100}, 4}, {{-130, 3, 20}, 5}};
    return grid;
}

SparseGrid read(const std::string& bytes, const std::string& name = "density") {
    return read_nanovdb(std::as_bytes(std::span(bytes)), name).value();
}

std::string error_of(const std::string& bytes) {
    try {
        read_nanovdb(std::as_bytes(std::span(bytes)), "density");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

float at(const SparseGrid& grid, Vec3 place) { return grid.grid->at(transform_point(grid.to_grid, place)).r; }

TEST(Nanovdb, HasItsNumbersWhereTheFileHasThem) {
    for (const std::uint16_t codec : {0, 1, 2}) {
        const auto points = some_points();
        const auto grid = read(nanovdb_file({points}, codec));
        for (const auto& [place, value] : points.points) {
            const auto metres = [&](std::size_t axis) {
                return float(points.origin[axis] + points.step * place[axis]);
            };
            EXPECT_NEAR(at(grid, {metres(0), metres(1), metres(2)}), value, 2e-4f * value);
        }
        EXPECT_NEAR(at(grid, {1.25f, 2, 3}), 2, 1e-3f) << "between two points";
        EXPECT_NEAR(at(grid, {1.75f, 2, 3}), 1.5f, 1e-3f) << "towards nothing";
        EXPECT_EQ(at(grid, {5, 5, 5}), 0);
        EXPECT_EQ(at(grid, {500, 5, 5}), 0);
    }
}

TEST(Nanovdb, TakesBlocksWhereSomethingIs) {
    NanovdbPoints far;
    far.points = {{{0, 0, 0}, 1}, {{1000, 1000, 1000}, 1}};
    const auto grid = read(nanovdb_file({far}));
    Medium smoke;
    smoke.extinction = {{1, 1, 1}, grid.grid, grid.to_grid};
    EXPECT_EQ(smoke.fault(), "");
    EXPECT_GT(grid.grid->points(), std::size_t{1000} * 1000 * 1000);
    EXPECT_LT(grid.grid->memory(), std::size_t{10} << 20);
}

TEST(Nanovdb, ChoosesByName) {
    auto first = some_points(), second = some_points();
    second.name = "temperature", second.points = {{{0, 0, 0}, 600}};
    const std::string file = nanovdb_file({first, second}) + nanovdb_file({first});
    EXPECT_THAT(names_in_nanovdb(std::as_bytes(std::span(file))), ElementsAre("density", "temperature", "density"));
    EXPECT_NEAR(at(read(file, "temperature"), {1, 2, 3}), 600, 0.1f);
    EXPECT_FALSE(read_nanovdb(std::as_bytes(std::span(file)), "heat"));
}

TEST(Nanovdb, TakesWhatIsBelowNothingAsNothing) {
    NanovdbPoints grid;
    grid.points = {{{0, 0, 0}, -1}, {{2, 0, 0}, 1}};
    EXPECT_EQ(at(read(nanovdb_file({grid})), {0, 0, 0}), 0);
    const NanovdbPoints nothing;
    EXPECT_EQ(at(read(nanovdb_file({nothing})), {0, 0, 0}), 0);
}

TEST(Nanovdb, SaysWhatItIsNot) {
    const std::string good = nanovdb_file({some_points()});
    const auto changed = [&](const std::function<void(std::string&)>& change) {
        std::string bytes = good;
        change(bytes);
        return error_of(bytes);
    };
    const std::size_t grid = 16 + 176 + std::strlen("density") + 1, root = grid + 672 + 64;
    EXPECT_EQ(error_of(good), "");
    EXPECT_THAT(error_of(""), HasSubstr("it ends early"));
    EXPECT_THAT(error_of("PK\3\4 and more bytes"), HasSubstr("does not begin with 'NanoVDB0'"));
    EXPECT_THAT(changed([](auto& b) { std::reverse(b.begin(), b.begin() + 8); }),
                HasSubstr("of another kind of machine"));
    EXPECT_THAT(changed([](auto& b) { b[7] = '1'; }), HasSubstr("a grid without a file's header"));
    EXPECT_THAT(changed([](auto& b) { b[11] = 3; }), HasSubstr("version 24.4 is not known (32 is)"));
    EXPECT_THAT(changed([](auto& b) { b[16 + 168] = 2; }), HasSubstr("it ends early"));
    EXPECT_THAT(changed([&](auto& b) { b[grid + 636] = 2; }), HasSubstr("is of type"));
    EXPECT_THAT(changed([&](auto& b) { b[grid + 632] = 1; }), HasSubstr("is not a fog volume"));
    EXPECT_THAT(changed([&](auto& b) { std::memset(&b[grid + 296 + 88], 0, 72); }), HasSubstr("transform is singular"));
    EXPECT_THAT(changed([&](auto& b) { std::memset(&b[root + 24], 0x7f, 4); }), HasSubstr("leads beyond it"));
    EXPECT_THAT(changed([&](auto& b) { std::memset(&b[root + 64 + 8], 0x7f, 8); }), HasSubstr("leads beyond it"));
    NanovdbPoints infinite;
    infinite.points = {{{0, 0, 0}, INFINITY}};
    EXPECT_THAT(error_of(nanovdb_file({infinite})), HasSubstr("a number is not finite"));
    std::string packed = nanovdb_file({some_points()}, 1);
    packed[grid + 30] = char(packed[grid + 30] + 1);
    EXPECT_NE(error_of(packed), "");
    std::string by_blosc = nanovdb_file({some_points()}, 2);
    by_blosc[grid + 8 + 12] = char(by_blosc[grid + 8 + 12] + 1);  // how many bytes there are, says Blosc
    EXPECT_THAT(error_of(by_blosc), HasSubstr("Blosc has packed is broken"));
    by_blosc[16 + 7] = 1;  // and the file: 2^56 and more
    EXPECT_THAT(error_of(by_blosc), HasSubstr("larger than Blosc can have packed"));
}

TEST(Nanovdb, DoesNotTakeMoreThanItSaysInProportion) {
    NanovdbPoints far;
    far.points = {{{0, 0, 0}, 1}, {{1 << 29, 1 << 29, 1 << 29}, 1}};
    EXPECT_THAT(error_of(nanovdb_file({far})), HasSubstr("which is more than can be held"));
    // all parts of the first node are one and the same
    NanovdbPoints one;
    one.points = {{{0, 0, 0}, 1}};
    std::string same = nanovdb_file({one});
    const std::size_t grid = 16 + 176 + 8, upper = grid + 672 + 64 + 64 + 32, lower = upper + 270400;
    std::memset(&same[upper + 4128], 0xff, 4096);
    for (std::size_t n = 0; n < 32768; ++n) {
        const std::uint64_t offset = lower - upper;
        std::memcpy(&same[upper + 8256 + 8 * n], &offset, 8);
    }
    EXPECT_THAT(error_of(same), HasSubstr("nodes of its tree lie on each other"));
    // each part of a lower node is another number
    std::string tiles = nanovdb_file({one});
    std::memset(&tiles[lower + 32], 0xff, 512);
    for (std::size_t n = 1; n < 4096; ++n) {
        const float value = float(n);
        std::memcpy(&tiles[lower + 1088 + 8 * n], &value, 4);
    }
    EXPECT_EQ(error_of(tiles), "") << "as many blocks as parts";
}

// Wherever it is cut.
TEST(Nanovdb, IsRefusedWhereItEndsEarly) {
    const std::string good = nanovdb_file({some_points()});
    for (std::size_t size = 0; size < good.size(); size += 1 + size / 3)
        EXPECT_NE(error_of(good.substr(0, size)), "") << size;
}

}  // namespace
}  // namespace lightnet::test::nanovdb_test
